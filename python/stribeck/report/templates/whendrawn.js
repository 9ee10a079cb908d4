// A page that holds its figures has them once the library has read them.
function whenDrawn() {
  if (Bokeh.documents.length === 0) { requestAnimationFrame(whenDrawn); return; }
  repaint();
  paintWhatIsSeen();
}
addEventListener("load", whenDrawn);
