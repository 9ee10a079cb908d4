"""Interactive figures by Bokeh, for pages, the workbench and notebooks; one file a figure.

A figure is a function of results. Figures that show samples take `Samples`: those that are given
the same one share its data source, so that samples selected in one are marked in all.
"""
