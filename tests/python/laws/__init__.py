"""Every law of the catalog against formulas written out from the papers, not from its code."""
