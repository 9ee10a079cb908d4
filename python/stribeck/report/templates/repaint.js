// Figures take their colours from the page, which changes them when it is printed or gets dark.
function repaint() {
  for (const root of Object.values(Bokeh.index)) {
    if (root.repaint_all) root.repaint_all();
    else if (root.invalidate_render) root.invalidate_render();
  }
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
matchMedia("print").addEventListener("change", repaint);
