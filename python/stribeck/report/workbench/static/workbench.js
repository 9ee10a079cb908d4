// What the pages cannot do without a script: figures, progress, dropped files.
"use strict";
const page = document.body.dataset;

// Progress: ask while work goes on, and show what is new in its place when something changed.
function clock(seconds, left) {
  const least = `${seconds.toFixed(0)} s`;
  return left === null ? `(${least})` : `(${least}, about ${Math.ceil(left)} s left)`;
}
let following = false, leaving = false;
// The number of the figures that are drawn.
let shown = "";
// Load the page again for other figures: they are not taken out of a page, since their memory would
// be lost. Until then the page is busy, so that nothing is typed or sent that the loading would undo.
// A page that is being left for another is not loaded again: that would keep the user on it.
addEventListener("beforeunload", () => { leaving = true; });
function load() {
  if (leaving) return;
  leaving = true;
  page.busy = "1";
  location.reload();
}
async function progress() {
  if (following) return;
  following = true;
  try {
    while (page.busy === "1" && !leaving) {
      const answer = await (await fetch(`${page.progress}&version=${page.version}`)).json();
      if (answer.version !== Number(page.version) || !answer.busy) {
        renew(await (await fetch(location.href)).text());
      } else {
        document.getElementById("said").textContent = answer.said;
        document.getElementById("clock").textContent = clock(answer.seconds, answer.left);
      }
    }
  } catch { if (!leaving) complain("The workbench has ended."); }
  following = false;
}
// Show the page as it is now. Figures that are drawn already stay, and so does what is typed. The
// status is a live region: it stays and gets new content.
function renew(text) {
  const now = new DOMParser().parseFromString(text, "text/html");
  const other = now.body.dataset.number;
  if (shown && other && other !== shown) { load(); return; }
  for (const typed of document.querySelectorAll("main input[id]")) {
    const field = now.getElementById(typed.id);
    if (field && typed.type !== "file" && typed.value !== typed.defaultValue) field.value = typed.value;
  }
  for (const place of now.querySelectorAll("[data-figure]")) {
    const drawn = document.querySelector(`[data-figure="${CSS.escape(place.dataset.figure)}"]`);
    if (drawn) place.replaceWith(drawn);
  }
  const status = document.querySelector(".status"), said = now.querySelector(".status");
  const focused = document.activeElement.id;
  status.replaceChildren(...said.childNodes);
  said.remove();
  while (status.nextSibling) status.nextSibling.remove();
  status.after(...now.querySelector("main").childNodes);
  if (focused) document.getElementById(focused)?.focus();
  document.querySelector(".of").replaceWith(now.querySelector(".of"));
  document.title = now.title;
  Object.assign(page, now.body.dataset);
  draw();
}
progress();

// A form is sent without leaving the page, unless another page answers it.
const path = (address) => new URL(address).pathname.replace(/^\/$/, "/data");
function complain(said) {
  const error = document.createElement("p");
  error.className = "error";
  error.textContent = said;
  document.querySelector(".status").replaceChildren(error);
  page.busy = "0";
}
let sending = false;
document.addEventListener("submit", async (event) => {
  event.preventDefault();
  if (sending || leaving) return;
  sending = true;
  page.busy = "1";
  const form = event.target, sent = new FormData(form);
  const body = form.enctype === "multipart/form-data" ? sent : new URLSearchParams(sent);
  try {
    // A field of the form is called "action".
    const answer = await fetch(form.getAttribute("action"), { method: "POST", body });
    if (!answer.ok) { complain(await answer.text()); draw(); }
    else if (path(answer.url) !== path(location.href)) location.assign(answer.url);
    else {
      form.reset();
      renew(await answer.text());
      progress();
    }
  } catch { if (!leaving) complain("The workbench has ended."); }
  sending = false;
});

// Files that are dropped anywhere on a form are sent with it.
for (const name of ["dragover", "dragleave", "drop"]) {
  document.addEventListener(name, (event) => {
    const form = event.target.closest(".drop");
    if (!form) return;
    event.preventDefault();
    form.classList.toggle("over", name === "dragover");
    if (name !== "drop") return;
    form.querySelector("input[type=file]").files = event.dataTransfer.files;
    form.requestSubmit();
  });
}

// Figures: one document, so that a selection in one marks the others.
const TYPES = { float32: Float32Array, float64: Float64Array, int32: Int32Array };
function decoded(column) {
  const bytes = Uint8Array.from(atob(column.content), (c) => c.charCodeAt(0));
  return new TYPES[column.type](bytes.buffer);
}
// A selection as stretches of rows of the recording: a zoom draws other samples of the same rows.
function stretches(rows, indices) {
  const found = [];
  for (const k of [...indices].sort((a, b) => a - b)) {
    const last = found[found.length - 1];
    if (last && k === last.at + 1) { last.at = k; last.to = rows[k]; } else found.push({ at: k, from: rows[k], to: rows[k] });
  }
  return found;
}
function within(rows, kept) {
  const chosen = [];
  let next = 0;
  for (let k = 0; k < rows.length; k++) {
    while (next < kept.length && rows[k] > kept[next].to) next++;
    if (next < kept.length && rows[k] >= kept[next].from) chosen.push(k);
  }
  return chosen;
}
function followZoom(bokeh) {
  const range = bokeh.get_model_by_name("window");
  const source = bokeh.get_model_by_name("samples");
  if (!range || !source) return;
  let waiting = 0, asked = 0, kept = [], redrawing = false;
  source.selected.properties.indices.change.connect(() => {
    if (!redrawing) kept = stretches(source.data.row, source.selected.indices);
  });
  async function answer() {
    const number = ++asked, began = performance.now();
    const reply = await fetch(`${page.window}&start=${range.start}&end=${range.end}`);
    const columns = await reply.json();
    if (number !== asked) return;
    redrawing = true;
    source.selected.indices = [];
    source.data = Object.fromEntries(Object.entries(columns).map(([name, c]) => [name, decoded(c)]));
    source.selected.indices = within(source.data.row, kept);
    redrawing = false;
    page.zoomed = String(Math.round(performance.now() - began));
  }
  for (const side of [range.properties.start, range.properties.end]) {
    side.change.connect(() => { clearTimeout(waiting); waiting = setTimeout(answer, 40); });
  }
}
// The library of the figures is large: it is loaded when the first are drawn, and on the first page
// ahead of them.
let library = null;
function bokeh() {
  library ??= Promise.all(page.library.split(" ").map((address) => new Promise((done, failed) => {
    const script = document.createElement("script");
    script.src = address;
    script.async = false;
    script.onload = done;
    script.onerror = failed;
    document.head.append(script);
  })));
  return library;
}
if (path(location.href) === "/data") addEventListener("load", bokeh);
let drawing = Promise.resolve();
function draw() {
  delete page.drawn;
  drawing = drawing.then(drawOnce, drawOnce);
}
async function drawOnce() {
  const places = [...document.querySelectorAll("[data-figure]")];
  if (!places.length) return;
  const made = await (await fetch(`${page.figures}&known=${shown}`)).json();
  if (made.same) {
    for (const place of places) place.hidden = !place.querySelector(".plot").hasChildNodes();
    page.drawn = "1";
    return;
  }
  // What is being sent must arrive first; its answer draws again.
  if (shown) { if (!sending) load(); return; }
  if (!made.item) { for (const place of places) place.hidden = true; return; }
  await bokeh();
  shown = made.number;
  // BokehJS fills the places in the order of the document: each figure needs one.
  for (const [name, id] of Object.entries(made.places)) {
    const place = places.find((one) => one.dataset.figure === name);
    const plot = place ? place.querySelector(".plot") : document.body.appendChild(document.createElement("div"));
    plot.hidden = !place;
    plot.id = made.item.roots[id];
  }
  for (const place of places) place.hidden = !(place.dataset.figure in made.places);
  const known = Bokeh.documents.length;
  await Bokeh.embed.embed_items(made.docs, [made.item]);
  if (Bokeh.documents.length > known) followZoom(Bokeh.documents[known]);
  repaint();
  // The first picture of every figure is made; two frames later it is painted.
  requestAnimationFrame(() => requestAnimationFrame(paintWhatIsSeen));
  page.drawn = "1";
}
draw();
