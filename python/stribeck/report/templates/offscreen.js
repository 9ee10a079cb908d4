// A figure that is out of sight is painted again when it is scrolled into sight: a selection or a
// zoom changes many figures, of which a few are seen.
function paintWhatIsSeen() {
  const plots = new Map();
  const watch = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) plots.get(target).hold_render = !isIntersecting;
  }, { rootMargin: "50px" });
  for (const view of Object.values(Bokeh.index)) {
    plots.set(view.el, view.model);
    watch.observe(view.el);
  }
}
