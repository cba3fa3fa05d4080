// Two pictures of a view with a slider between them, and what the ray of a pixel did.

const KINDS = { image: "picture", error: "error", levels: "levels" };
const pictureName = (p) => `${p.method === "full" ? "full resolution" : `${p.method}, ${p.setting}`}: ${KINDS[p.kind] ?? p.kind}${p.samples > 1 ? `, ${p.samples} samples` : ""}`;

/** A picture's file, made once of the page's text. */
const urls = new Map();
function urlOf(picture) {
  if (!urls.has(picture.id)) urls.set(picture.id, URL.createObjectURL(new Blob([bytes(document.getElementById(picture.id).textContent)], { type: "image/jpeg" })));
  return urls.get(picture.id);
}

/** What the colours of a picture mean. */
function pictureLegend(picture, scene) {
  if (picture.kind === "error") return h("div", { class: "legend" }, h("span", {}, "largest channel difference: 0"), h("span", { class: "ramp", role: "img", "aria-label": "black, red, yellow, white" }), h("span", {}, `${page.palette.hottest} of 255 and more`));
  if (picture.kind !== "levels") return "";
  const levels = page.palette.levels.slice(0, (scene?.levels ?? 10) + 1);
  return h("div", { class: "legend" }, "level of the triangle hit:", levels.map((rgb, k) => h("span", {}, h("span", { class: "swatch", style: `background:rgb(${rgb.join(",")})`, "aria-hidden": "true" }), k === 0 ? "0 base" : k === levels.length - 1 ? `${k} finest` : String(k))));
}

function picturesSection(section, state) {
  const doc = page.error_time;
  const own = { view: null, a: null, b: null, at: 50, pixel: null };
  const body = h("div", {});
  let traces;
  const viewsOf = () => doc.views.map((v, k) => ({ ...v, k, scene: doc.scenes[v.scene] })).filter((v) => v.scene.name === state.scene && page.pictures.some((p) => p.view === v.k)).sort(by((v) => v.distance));
  const draw = () => {
    const views = viewsOf();
    if (!views.length) return body.replaceChildren(h("p", { class: "note" }, "There are no pictures of this scene."));
    const view = views.find((v) => v.k === own.view) ?? views[Math.floor((views.length - 1) / 2)];
    own.view = view.k;
    const pictures = page.pictures.filter((p) => p.view === view.k);
    const find = (name) => pictures.find((p) => pictureName(p) === name);
    const first = (...tests) => tests.map((test) => pictures.find(test)).find(Boolean) ?? pictures[0];
    const a = find(own.a) ?? first((p) => isOurs(p.method) && p.kind === "image");
    const b = find(own.b) ?? first((p) => p.method === "full" && p.kind === "image", (p) => p !== a);
    [own.a, own.b] = [pictureName(a), pictureName(b)];
    const options = unique(pictures.map((p) => p.method)).map((method) => ({ group: method === "full" ? "full resolution" : method, options: pictures.filter((p) => p.method === method).map((p) => [pictureName(p), pictureName(p)]) }));
    const controls = h(
      "div", { class: "controls" },
      choice("View", views.map((v) => [v.k, `${v.scene.name} from ${num(v.distance)} radii`]), view.k, (value) => ((own.view = Number(value)), draw())),
      choice("Left picture", options, own.a, (value) => ((own.a = value), draw())),
      choice("Right picture", options, own.b, (value) => ((own.b = value), draw())),
    );
    const middle = [Math.floor(view.size[0] / 2), Math.floor(view.size[1] / 2)];
    own.pixel ??= middle;
    own.pixel = own.pixel.map((v, k) => Math.min(v, view.size[k] - 1));
    const [under, over] = [h("img", { src: urlOf(b), alt: `${pictureName(b)}, ${view.scene.name} from ${num(view.distance)} radii`, draggable: "false" }), h("img", { src: urlOf(a), alt: `${pictureName(a)}, ${view.scene.name} from ${num(view.distance)} radii`, draggable: "false" })];
    const rule = h("div", { class: "rule" });
    const spot = h("div", { class: "spot" });
    const frame = h("div", { class: "slider", style: `aspect-ratio:${view.size[0]}/${view.size[1]}` }, under, over, rule, h("span", { class: "tag a" }, pictureName(a)), h("span", { class: "tag b" }, pictureName(b)), spot);
    const range = h("input", { type: "range", class: "wide", id: "slide", min: "0", max: "100", step: "1", value: own.at, "aria-label": "Share of the left picture", oninput: () => slide() });
    const slide = () => {
      own.at = Number(range.value);
      over.style.clipPath = `inset(0 ${100 - own.at}% 0 0)`;
      rule.style.left = `${own.at}%`;
      range.setAttribute("aria-valuetext", `${own.at} % ${pictureName(a)}, ${100 - own.at} % ${pictureName(b)}`);
    };
    slide();
    const grids = () => (traces ?? []).filter((t) => t.view === view.k);
    const result = h("div", { class: "rays", "aria-live": "polite", id: "inspected" });
    const column = h("input", { type: "number", min: "0", max: view.size[0] - 1, value: own.pixel[0], onchange: () => go([Number(column.value), own.pixel[1]]) });
    const row = h("input", { type: "number", min: "0", max: view.size[1] - 1, value: own.pixel[1], onchange: () => go([own.pixel[0], Number(row.value)]) });
    const go = (pixel) => {
      const all = grids();
      // Rays were followed on a grid: the nearest of it.
      const at = all.length ? nearestRay(all[0], pixel) : null;
      own.pixel = at == null ? pixel : all[0].rays[at].pixel;
      [column.value, row.value] = own.pixel;
      spot.style.left = `${(100 * (own.pixel[0] + 0.5)) / view.size[0]}%`;
      spot.style.top = `${(100 * (own.pixel[1] + 0.5)) / view.size[1]}%`;
      const wanted = unique([a, b].map((p) => p.method));
      const chosen = all.filter((t) => wanted.includes(t.method)).sort(by((t) => wanted.indexOf(t.method)));
      const list = chosen.length ? chosen : all.slice(0, 2);
      result.replaceChildren(...(list.length ? list.map((t) => rayCard(t, t.rays[nearestRay(t, own.pixel)])) : [h("p", { class: "note" }, traces ? "No rays of this view were followed." : "Reading the rays …")]));
    };
    const move = (event) => {
      const all = grids();
      const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!by || !all.length) return;
      event.preventDefault();
      const { size, grid } = all[0];
      go(own.pixel.map((v, k) => Math.max(0, Math.min(size[k] - 1, v + Math.round((by[k] * size[k]) / grid[k])))));
    };
    frame.setAttribute("tabindex", "0");
    frame.setAttribute("role", "group");
    frame.setAttribute("aria-label", "The two pictures. Dragging moves the slider between them. Arrow keys or a click choose the pixel whose ray is shown.");
    frame.addEventListener("keydown", move);
    // Dragging moves the slider; a click that did not drag chooses a pixel.
    let [from, dragged] = [null, false];
    frame.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      [from, dragged] = [event.clientX, false];
      frame.setPointerCapture(event.pointerId);
    });
    frame.addEventListener("pointermove", (event) => {
      if (from == null || (!dragged && Math.abs(event.clientX - from) < 4)) return;
      dragged = true;
      const box = frame.getBoundingClientRect();
      range.value = Math.max(0, Math.min(100, (100 * (event.clientX - box.left)) / box.width));
      slide();
    });
    for (const end of ["pointerup", "pointercancel"]) frame.addEventListener(end, () => (from = null));
    frame.addEventListener("click", (event) => {
      if (dragged) return;
      const box = frame.getBoundingClientRect();
      go([Math.floor(((event.clientX - box.left) / box.width) * view.size[0]), Math.floor(((event.clientY - box.top) / box.height) * view.size[1])]);
    });
    const scaled = a.width < view.size[0] ? h("p", { class: "note" }, `Of a frame of ${view.size.join(" × ")}${view.every > 1 ? `, every ${ordinal(view.every)} column and row` : ""}; embedded at ${a.width} × ${a.height}.`) : "";
    const hasTraces = document.getElementById("traces") != null;
    body.replaceChildren(
      controls,
      h(
        "div", { class: "stage" },
        h("div", {}, frame, range, pictureLegend(a, view.scene), b.kind === a.kind ? "" : pictureLegend(b, view.scene), scaled),
        hasTraces ? h("div", {}, h("h3", {}, "Pixel inspector"), h("p", { class: "note" }, "Click the picture, or move with the arrow keys when it has the focus; dragging moves the slider. Rays were followed on a grid; the nearest is shown."), h("div", { class: "controls" }, control("Column", column), control("Row", row)), result) : "",
      ),
    );
    if (!hasTraces) spot.remove();
    else if (traces) go(own.pixel);
    else {
      go(own.pixel);
      // First a ray near the middle that hits something, if one does.
      const first = (all) => d3.least(all.filter((t) => t.view === view.k)[0]?.rays.filter((r) => r.hit) ?? [], (r) => d3.sum(r.pixel, (v, k) => (v - middle[k]) ** 2))?.pixel;
      block("traces").then((all) => ((traces = all), go(first(all) ?? own.pixel)));
    }
  };
  state.showPicture = (point) => {
    own.view = point.view;
    own.a = pictureName(page.pictures.find((p) => p.view === point.view && p.method === point.method && p.setting === point.setting) ?? page.pictures.find((p) => p.view === point.view && p.method === point.method) ?? page.pictures[0]);
    draw();
    document.getElementById("pictures").scrollIntoView();
  };
  section.append(body);
  // Decoded when it comes into sight: the page opens sooner.
  let seen = false;
  new IntersectionObserver((entries, observer) => entries.some((e) => e.isIntersecting) && (observer.disconnect(), (seen = true), draw()), { rootMargin: "400px" }).observe(section);
  state.onChange(() => seen && draw());
}

const nearestRay = (grid, [x, y]) => d3.minIndex(grid.rays, (r) => (r.pixel[0] - x) ** 2 + (r.pixel[1] - y) ** 2);

const ENDS = { h: "hit", m: "hit, mapped to full resolution", n: "nothing met" };

/** A step's word in words; src/report/inspect.rs has the table. */
function stepOf(word, sections) {
  const visits = word.startsWith("*");
  const [act, fetch] = (visits ? word.slice(1) : word).split("@");
  const [letter, rest] = [act[0], act.slice(1)];
  const [node, states] = rest.split(":");
  const [level, number] = node.split(".");
  const where = number == null ? "" : ` of level ${level} node ${num(Number(number))}`;
  const edges = (states ?? "").split(".").map((s) => (Number(s) === 256 ? "1" : Number(s) === 0 ? "0" : `${s}/256`));
  const words = {
    f: () => (fetch?.includes("=") ? "lines written" : "lines read"), y: () => "which ray decides in this tree", k: () => `${count(Number(states), "operation")} of the method’s own`, t: () => "inserted vertices morphed", o: () => "next node taken from the stack", d: () => "node from the stack dropped: it lies behind the closest hit",
    r: () => `LOD test${where}: refine${states ? `, edge states ${edges.join(", ")}` : ""}`, s: () => `LOD test${where}: its triangle serves`,
    x: () => `${count(Number(node), "triangle")} tested, ${num([...Number(states).toString(2)].filter((b) => b === "1").length)} met`,
  };
  const [children, bounds] = page.shapes[letter] ?? [];
  const text = bounds ? `${children} children tested, ${rest} met (${bounds})` : ENDS[letter] ?? words[letter]?.() ?? word;
  const match = fetch && /^(\+?)=?(\d+)\.(\d+)\.(\d+)$/.exec(fetch);
  const lines = match && { together: match[1] === "+", section: sections[match[2]] ?? match[2], first: Number(match[3]), count: Number(match[4]) };
  return { visits, letter, text, lines, tests: letter === "x" ? Number(node) : 0 };
}

function rayCard(grid, ray) {
  const steps = ray.steps.split(" ").filter(Boolean).map((word) => stepOf(word, grid.sections));
  const sum = (f) => d3.sum(steps, f);
  const facts = [
    ["hit", ray.hit ? `level ${ray.hit.level}, tree ${num(ray.hit.tree)}, node ${num(ray.hit.node)}, at ${num(ray.hit.distance, 5)}` : "nothing"],
    ["node visits", num(sum((s) => (s.visits ? 1 : 0)))], ["LOD tests", num(sum((s) => (s.letter === "r" || s.letter === "s" ? 1 : 0)))], ["triangles tested", num(sum((s) => s.tests))],
    ...d3.rollups(steps.filter((s) => s.lines), (of) => d3.sum(of, (s) => s.lines.count), (s) => s.lines.section).map(([name, lines]) => [`lines of ${name}`, num(lines)]),
  ];
  const range = (l) => (l.count === 1 ? `line ${num(l.first)}` : `lines ${num(l.first)} to ${num(l.first + l.count - 1)}`);
  const command = grid.command && `${grid.command} ${ray.pixel.join(",")}`;
  const copy = command && h("button", { type: "button", "aria-label": `Copy the trace command of ${grid.method}`, onclick: () => navigator.clipboard?.writeText(command).then(() => (copy.textContent = "Copied"), () => {}) }, "Copy");
  return h(
    "article", { class: "ray", "data-method": grid.method, "data-pixel": ray.pixel.join(",") },
    h("h4", { style: "margin:0;display:flex;gap:.45rem;align-items:center" }, swatch(grid.method), `${grid.method}, ${grid.setting}: pixel ${ray.pixel.join(", ")}`),
    h("dl", {}, facts.map(([a, b]) => h("div", {}, h("dt", {}, a), h("dd", {}, b)))),
    h("ol", { class: "steps", tabindex: "0", role: "list", "aria-label": `Steps of ${grid.method}` }, steps.map((s) => h("li", { class: s.visits ? "visit" : null }, s.text, s.lines ? h("span", { class: "lines" }, `; ${s.lines.together ? "with it " : ""}${range(s.lines)} of ${s.lines.section}`) : null))),
    command ? h("div", { class: "command" }, h("code", {}, command), copy) : h("p", { class: "note" }, "lodray trace follows rays of lod only."),
  );
}
