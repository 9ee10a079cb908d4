// Figures take their colours from the page, which changes them when it gets dark or is printed.
// Legends are drawn before they are part of the page, and words in a figure take no colour from it:
// they are told the colour.
function repaint() {
  const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
  for (const drawn of Bokeh.documents) {
    for (const model of drawn.all_models) {
      if (model.type === "Legend") model.label_text_color = ink;
      if (model.type === "Text") model.text_color = ink;
      if (model.type === "ColorBar") model.title_text_color = model.major_label_text_color = ink;
    }
  }
  for (const view of Object.values(Bokeh.index)) {
    if (!view.repaint) continue;
    const held = view.model.hold_render;
    view.model.hold_render = false;
    view.repaint();
    view.model.hold_render = held;
  }
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { if (window.Bokeh) repaint(); });
// Figures are not laid out again for the paper: it gets pictures of them, which fit.
function takePictures(printed) {
  for (const picture of document.querySelectorAll("canvas.printed")) picture.remove();
  if (!printed) return;
  for (const view of Object.values(Bokeh.index)) {
    if (!view.repaint) continue;
    const picture = view.export("auto", true).canvas;
    picture.className = "printed";
    view.el.after(picture);
  }
}
matchMedia("print").addEventListener("change", ({ matches }) => { if (window.Bokeh) { repaint(); takePictures(matches); } });
