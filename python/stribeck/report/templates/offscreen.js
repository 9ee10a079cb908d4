// A figure that is out of sight is painted again when it is scrolled into sight: a selection or a
// zoom changes many figures, of which a few are seen. All are painted when the page gets another
// width, since that moves what is below them.
function paintWhatIsSeen() {
  const plots = new Map(), seen = new Set();
  const hold = () => { for (const [el, plot] of plots) plot.hold_render = !seen.has(el); };
  const watch = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) seen.add(target); else seen.delete(target);
      plots.get(target).hold_render = !isIntersecting;
    }
  }, { rootMargin: "50px" });
  for (const view of Object.values(Bokeh.index)) {
    plots.set(view.el, view.model);
    watch.observe(view.el);
  }
  let wide = innerWidth, settled = 0;
  addEventListener("resize", () => {
    if (innerWidth === wide) return;
    wide = innerWidth;
    for (const plot of plots.values()) plot.hold_render = false;
    clearTimeout(settled);
    settled = setTimeout(hold, 500);
  });
}
