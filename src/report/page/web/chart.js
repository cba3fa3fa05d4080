// Diagrams: Observable Plot draws, and every point is reached by pointer and by keyboard.

/** Two triangles that meet in a point, of this area: neither Plot nor D3 has such a symbol. */
const HOURGLASS = {
  draw(context, size) {
    const s = Math.sqrt(size / 2);
    context.moveTo(-s, -s);
    context.lineTo(s, -s);
    context.lineTo(-s, s);
    context.lineTo(s, s);
    context.closePath();
  },
};
/** The same on its side. */
const BOWTIE = {
  draw(context, size) {
    const s = Math.sqrt(size / 2);
    context.moveTo(-s, -s);
    context.lineTo(s, s);
    context.lineTo(s, -s);
    context.lineTo(-s, s);
    context.closePath();
  },
};
/** Twice as wide as high, of this area. */
const BAR = {
  draw(context, size) {
    const s = Math.sqrt(size / 2);
    context.rect(-s, -s / 2, 2 * s, s);
  },
};
/** The same on its end. */
const POST = {
  draw(context, size) {
    const s = Math.sqrt(size / 2);
    context.rect(-s / 2, -s, s, 2 * s);
  },
};
/** A hexagon of this area. */
const HEXAGON = {
  draw(context, size) {
    const r = Math.sqrt((2 * size) / (3 * Math.sqrt(3)));
    for (let k = 0; k < 6; k++) context[k === 0 ? "moveTo" : "lineTo"](r * Math.sin((k * Math.PI) / 3), -r * Math.cos((k * Math.PI) / 3));
    context.closePath();
  },
};
/** Marks as Plot has them. */
const ARROW = {
  draw(context, size) {
    const r = Math.sqrt(size / 2.4);
    context.moveTo(-r, -r);
    context.lineTo(1.2 * r, 0);
    context.lineTo(-r, r);
    context.lineTo(-r / 3, 0);
    context.closePath();
  },
};
const SYMBOLS = { circle: "circle", square: "square", triangle: "triangle", diamond: "diamond", cross: "plus", star: "asterisk", wye: "wye", times: "times", pentagram: "star", greekcross: "cross", hexagon: HEXAGON, hourglass: HOURGLASS, bowtie: BOWTIE, bar: BAR, post: POST, arrow: ARROW };
const colour = (method) => `var(--method-${CSS.escape(method)})`;
const symbol = (method) => SYMBOLS[page.palette.methods[method]?.mark] ?? "circle";
const D3_SYMBOLS = { circle: d3.symbolCircle, square: d3.symbolSquare, triangle: d3.symbolTriangle, diamond: d3.symbolDiamond, plus: d3.symbolPlus, asterisk: d3.symbolAsterisk, wye: d3.symbolWye, times: d3.symbolTimes, star: d3.symbolStar, cross: d3.symbolCross };
const STROKED = new Set(["plus", "asterisk", "times"]);

/** A method's mark as a small drawing. */
function swatch(method) {
  const name = symbol(method);
  const path = d3.symbol(D3_SYMBOLS[name] ?? name, 62)();
  const paint = STROKED.has(name) ? `fill="none" stroke="${colour(method)}" stroke-width="2.2"` : `fill="${colour(method)}"`;
  const span = h("span", { "aria-hidden": "true" });
  span.innerHTML = `<svg width="16" height="16" viewBox="-8 -8 16 16"><path d="${path}" ${paint}/></svg>`;
  return span.firstChild;
}

/** Lines of each hatching in a square of 8, by its number; the first has none. */
const HATCHES = ["", "M-2,2l4,-4M0,8l8,-8M6,10l4,-4", "M0,4h8", "M-2,6l4,4M0,0l8,8M6,-2l4,4", "M4,0v8", "M0,4h8M4,0v8", "M0,0l8,8M0,8l8,-8", "M1,2h2M5,6h2"];
const hatchId = (part, hatch) => `hatch-${part}-${hatch}`;

/** The patterns of every part of a machine. */
function hatchings() {
  const holder = h("div", { "aria-hidden": "true" });
  const pattern = (part) => (lines, k) => `<pattern id="${hatchId(part, k)}" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="var(--part-${part})"/><path d="${lines}" fill="none" stroke="var(--ground)" stroke-width="1.6"/></pattern>`;
  holder.innerHTML = `<svg width="0" height="0" style="position:absolute"><defs>${page.palette.parts.flatMap((p) => HATCHES.map(pattern(p.name))).join("")}</defs></svg>`;
  return holder;
}

/** How what is waited for, or limits, is filled: the same wherever it stands on the page. */
function fillOf(name) {
  const [part, hatch] = page.palette.things[name] ?? ["leakage", 0];
  return hatch === 0 ? `var(--part-${part})` : `url(#${hatchId(part, hatch)})`;
}
const sectionFill = (name) => (page.palette.sections.some((s) => s.name === name) ? `var(--section-${name})` : "var(--part-leakage)");

/** A filled square and its name, for each. */
function swatchKeys(label, names, fill) {
  const square = (name) => {
    const span = h("span", { "aria-hidden": "true", style: "display:inline-flex" });
    span.innerHTML = `<svg width="20" height="15"><rect width="20" height="15" rx="3" style="fill:${fill(name)}"/></svg>`;
    return span;
  };
  return h("ul", { class: "keys", "aria-label": label }, names.map((name) => h("li", {}, square(name), name)));
}

/** Which mark is which method. */
const keys = (methods, more = []) => h("ul", { class: "keys", "aria-label": "Marks" }, methods.map((m) => h("li", {}, swatch(m), h("span", {}, m))), more.map((item) => h("li", {}, item)));

const lineKey = (dash, text, width = 2, opacity = 1) => {
  const span = h("span", { style: "display:inline-flex;gap:.4rem;align-items:center" });
  span.innerHTML = `<svg width="26" height="10" aria-hidden="true"><line x1="0" y1="5" x2="26" y2="5" stroke="currentColor" stroke-width="${width}" stroke-opacity="${opacity}" ${dash ? `stroke-dasharray="${dash}"` : ""}/></svg>`;
  span.append(text);
  return span;
};

/** Ends of an axis with room, in whole steps of 1, 2, 5 if it is logarithmic. */
function domain(values, linear, room = 1.25) {
  const [low, high] = d3.extent(values);
  if (low == null) return linear ? [0, 1] : [0.1, 10];
  if (linear) return low === high ? [low - 1, high + 1] : [low - (high - low) * 0.06, high + (high - low) * 0.08];
  return low === high ? [low / 3, high * 3] : [low / room, high * room];
}

/** Ticks of a logarithmic axis, at most one for each `each` pixels: powers of ten, with 2 and 5 or more between where there is room, fewer powers where there is none. */
function logTicks([low, high], room, each) {
  const most = Math.max(2, Math.floor(room / each));
  const of = (factors, step = 1) => {
    const all = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e++) if (e % step === 0) for (const f of factors) all.push(Number((f * 10 ** e).toPrecision(3)));
    return all.filter((v) => v >= low * 0.999 && v <= high * 1.001);
  };
  const choices = [of([1, 1.5, 2, 3, 4, 5, 7]), of([1, 2, 3, 5]), of([1, 2, 5]), of([1, 3]), of([1]), of([1], 2), of([1], 3), of([1], 4)];
  const gap = (ticks) => d3.min(d3.pairs(ticks, (a, b) => (Math.log(b / a) / Math.log(high / low)) * room)) ?? room;
  return choices.find((ticks) => ticks.length <= most && gap(ticks) >= 0.75 * each) ?? [];
}

/** Both axes of a diagram: scales and marks. d3 hides labels of logarithmic axes as it likes, so these are their own. */
function axes({ width, height, x, y, margins }) {
  const rooms = [width - margins.marginLeft - margins.marginRight, height - margins.marginTop - margins.marginBottom];
  const scale = (a) => (a.linear ? { type: "linear", domain: a.domain, reverse: a.reverse, axis: null } : { type: "log", domain: a.domain, axis: null });
  const ticks = (a, room, each) => a.ticks ?? (a.linear ? d3.ticks(...a.domain, Math.max(2, Math.floor(room / each))) : logTicks(a.domain, room, each));
  const [xs, ys] = [ticks(x, rooms[0], 44), ticks(y, rooms[1], 24)];
  const text = (a) => (v) => (a.linear || a.ticks ? num(v) : tick(v));
  return {
    scales: { ...margins, width, height, x: scale(x), y: scale(y) },
    marks: [
      Plot.gridX(xs, { strokeOpacity: 0.12 }), Plot.gridY(ys, { strokeOpacity: 0.12 }), Plot.frame({ strokeOpacity: 0.25 }),
      Plot.axisX(xs, { text: text(x), label: x.label || null, labelAnchor: "center", labelArrow: "none", tickSize: 4 }),
      Plot.axisY(ys, { text: text(y), label: y.label || null, labelArrow: "none", tickSize: 4 }),
    ],
  };
}

/** Draws again whenever there is another width. */
function responsive(figure, draw) {
  let width = 0;
  const observer = new ResizeObserver(() => {
    const now = Math.round(figure.clientWidth);
    if (now > 0 && now !== width) draw((width = now));
  });
  observer.observe(figure);
}

/**
 * A diagram of `rows` ({x, y, method, title, lines}): `marks(rows)` are Plot's, of which those with the class "points" are drawn in the order of the rows and can be met.
 * @returns a figure
 */
function diagram({ title, small, label, rows, options, open }) {
  const figure = h("figure", { class: "chart" }, h("figcaption", {}, title, small ? h("small", {}, ` ${small}`) : null));
  const holder = h("div", {});
  const tip = h("div", { class: "tip", hidden: true, "aria-hidden": "true" });
  figure.append(holder, tip);
  responsive(figure, (width) => {
    tip.hidden = true;
    const svg = Plot.plot({ ...options(width), width, className: "plot", style: { fontSize: "12px", fontFamily: "inherit", background: "none" } });
    svg.setAttribute("role", "group");
    svg.setAttribute("aria-label", `${label ?? title}. Arrow keys go from point to point.`);
    svg.querySelectorAll("[aria-label]").forEach((g) => g.removeAttribute("aria-label"));
    svg.querySelectorAll("g").forEach((g) => !g.matches(".points, .points *") && g.setAttribute("aria-hidden", "true"));
    meet(svg, rows, tip, figure, open);
    holder.replaceChildren(svg);
  });
  return figure;
}

/** Pointer and keys on the points of a diagram. */
function meet(svg, rows, tip, figure, open) {
  const elements = [];
  for (const element of svg.querySelectorAll(".points > *")) {
    const row = rows[element.__data__];
    if (!row) continue;
    element.setAttribute("data-point", element.__data__);
    element.setAttribute("data-x", row.x);
    element.setAttribute("data-y", row.y);
    element.setAttribute("role", "img");
    element.setAttribute("aria-label", [row.title, ...row.lines.map(([a, b]) => `${a} ${b}`)].join(", "));
    element.setAttribute("tabindex", "-1");
    elements.push([element, row]);
  }
  // By x, then by y: the order in which arrows go.
  elements.sort(([, a], [, b]) => a.x - b.x || a.y - b.y);
  elements[0]?.[0].setAttribute("tabindex", "0");
  const show = (element, row) => {
    svg.querySelectorAll(".on").forEach((other) => other.classList.remove("on"));
    element.classList.add("on");
    tip.replaceChildren(h("b", {}, row.title), h("table", {}, h("tbody", {}, row.lines.map(([a, b]) => h("tr", {}, h("td", {}, a), h("td", {}, b))))), open && row.point?.view != null ? h("div", { class: "note" }, "Enter or click: its picture") : "");
    tip.hidden = false;
    const [box, frame] = [element.getBoundingClientRect(), figure.getBoundingClientRect()];
    const right = box.right - frame.left + 12;
    const left = right + tip.offsetWidth < frame.width ? right : box.left - frame.left - tip.offsetWidth - 12;
    tip.style.left = `${Math.max(0, Math.min(left, frame.width - tip.offsetWidth))}px`;
    const above = box.top - frame.top - tip.offsetHeight - 8;
    const beside = box.top - frame.top - tip.offsetHeight / 3;
    tip.style.top = `${left < 0 || frame.width < 420 ? (above > -40 ? above : box.bottom - frame.top + 8) : beside}px`;
  };
  const hide = () => {
    tip.hidden = true;
    svg.querySelectorAll(".on").forEach((other) => other.classList.remove("on"));
  };
  elements.forEach(([element, row], k) => {
    element.addEventListener("pointerenter", () => show(element, row));
    element.addEventListener("pointerleave", () => document.activeElement !== element && hide());
    element.addEventListener("focus", () => show(element, row));
    element.addEventListener("blur", hide);
    element.addEventListener("click", () => (element.focus(), open?.(row)));
    element.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, Home: -k, End: elements.length - 1 - k }[event.key];
      if (event.key === "Escape") hide();
      else if (event.key === "Enter") open?.(row);
      else if (step !== undefined) {
        const next = elements[Math.max(0, Math.min(elements.length - 1, k + step))][0];
        element.setAttribute("tabindex", "-1");
        next.setAttribute("tabindex", "0");
        next.focus();
        event.preventDefault();
      }
    });
  });
  // Small marks are hard to hit: the nearest one within reach is met.
  svg.addEventListener("pointermove", (event) => {
    if (event.target.closest("[data-point]")) return;
    let [nearest, least] = [null, 16];
    for (const [element, row] of elements) {
      const box = element.getBoundingClientRect();
      const distance = Math.hypot((box.left + box.right) / 2 - event.clientX, (box.top + box.bottom) / 2 - event.clientY);
      if (distance < least) [nearest, least] = [[element, row], distance];
    }
    nearest ? show(...nearest) : svg.contains(document.activeElement) || hide();
  });
  svg.addEventListener("pointerleave", () => svg.contains(document.activeElement) || hide());
}

const place = (point) => (point.distance == null ? "rays of a file" : point.byRadii === false ? `eye at ${num(point.distance)}` : `${num(point.distance)} radii`);
const samplesOf = (point) => count(point.samples, "sample");

/** What a point's tip says. */
function tipOf(point, more) {
  const knobs = Object.entries({ ...point.knobs, ...point.choices }).filter(([name]) => !point.setting.includes(name));
  return { title: `${point.method}, ${point.setting}`, lines: [["scene", point.scene], ["from", place(point)], ["samples", String(point.samples)], ...knobs, ...more] };
}
