// Work-precision diagrams: any error against any cost.

const isOurs = (method) => method === "lod";

/** A knob's value, short, to write beside a mark. */
const knobOf = (point) => {
  const value = point.knobs?.delta ?? /delta (\S+)/.exec(point.setting)?.[1];
  return value == null ? "" : ({ 0.0625: "1/16", 0.125: "1/8", 0.25: "1/4", 0.5: "1/2" }[value] ?? String(value));
};

function workSection(section, state) {
  const body = h("div", {});
  const own = { error: null, cost: "milliseconds", distance: "all" };
  const draw = () => {
    const points = state.points();
    const errors = errorMeasures().filter((m) => points.some((p) => errorOf(p, m) != null));
    if (!errors.length) return body.replaceChildren(h("p", { class: "note" }, "These results have costs only: nothing was compared with full resolution."));
    const error = errors.find((m) => m.id === own.error) ?? errors[0];
    const costs = COSTS.filter((c) => points.some((p) => c.of(p, costAt(p, state.machine)) != null));
    const cost = costs.find((c) => c.id === own.cost) ?? costs[0];
    const distances = unique(points.map(place));
    if (own.distance !== "all" && !distances.includes(own.distance)) own.distance = "all";
    const groups = unique(errors.map((m) => m.group)).map((group) => ({ group, options: errors.filter((m) => m.group === group).map((m) => [m.id, titled(m.name, m.unit)]) }));
    const set = (key) => (value) => ((own[key] = value), draw());
    const controls = h(
      "div", { class: "controls" },
      choice("Error", groups, error.id, set("error")),
      choice("Cost", costs.map((c) => [c.id, titled(c.name, costUnit(c, points, state.machine))]), cost.id, set("cost")),
      choice("Distance", [["all", `all ${distances.length}, side by side`], ...distances.map((d) => [d, d])], own.distance, set("distance")),
    );
    const rows = points.flatMap((p) => {
      const [x, y] = [cost.of(p, costAt(p, state.machine)), errorOf(p, error)];
      const unit = costUnit(cost, points, state.machine);
      if (x == null || y == null || !(x > 0)) return [];
      return [{ x, y, rank: error.larger ? -y : y, point: p, method: p.method, ...tipOf(p, [[error.name, `${num(y)} ${error.unit ?? ""}`], [cost.name, `${num(x)} ${unit}`]]) }];
    });
    const methods = unique(rows.map((r) => r.method));
    const chosen = distances.filter((d) => own.distance === "all" || d === own.distance);
    const least = rounding(rows.map((r) => r.y));
    const shared = own.distance === "all" ? { least, y: domain(rows.filter((r) => error.linear || r.y > least).map((r) => r.y), error.linear) } : {};
    const charts = chosen.map((distance) => workDiagram(rows.filter((r) => place(r.point) === distance), { error, cost, distance, shared, large: chosen.length === 1, state, unit: costUnit(cost, points, state.machine) }));
    const columns = [
      { name: "scene", value: (r) => r.point.scene }, { name: "from", value: (r) => place(r.point) }, { name: "method", value: (r) => r.method }, { name: "setting", value: (r) => r.point.setting },
      { name: "samples", value: (r) => r.point.samples }, { name: titled(error.name, error.unit), value: (r) => r.y }, { name: titled(cost.name, costUnit(cost, points, state.machine)), value: (r) => r.x },
      { name: "front", value: (r) => (r.onFront ? "yes" : "") },
    ];
    const shown = rows.filter((r) => chosen.includes(place(r.point)));
    const more = [lineKey("", "front: nothing is better at less", 8, 0.22)];
    if (shown.some((r) => shiftOf(r.point, error) != null)) more.push(lineKey("7 4", "full resolution, camera shifted by half a pixel", 1.6));
    const axes = charts.length > 1 ? h("p", { class: "note" }, h("b", {}, "Upward: "), titled(error.name, error.unit), h("b", {}, "; rightward: "), titled(cost.name, costUnit(cost, points, state.machine)), error.linear ? "." : "; both logarithmic, the upward axis the same everywhere.") : "";
    body.replaceChildren(controls, keys(methods, more), axes, h("p", { class: "note" }, chosen.length === 1 ? "The number beside a mark of ours is its delta." : "One distance alone, chosen above, has the deltas beside our marks."), h("div", { class: chosen.length === 1 ? "" : "grid" }, charts), dataTable(`${error.name} against ${cost.name}, ${state.scene}`, columns, shown));
  };
  section.append(
    h("p", {}, "Each mark is a method with one setting of its knob; further down is more exact, further left is cheaper. Filled marks lie on the front of all methods together, hollow ones are beaten by another."),
    body,
  );
  state.onChange(draw);
}

function workDiagram(rows, { error, cost, distance, shared, large, state, unit }) {
  const best = front(rows);
  rows.forEach((row) => (row.onFront = best.includes(row)));
  const least = shared.least ?? rounding(rows.map((r) => r.y));
  const isExact = (row) => !error.linear && row.y <= least;
  const seen = rows.filter((row) => !isExact(row));
  const shift = rows.map((r) => shiftOf(r.point, error)).find((v) => v != null && (error.linear || v > 0));
  const values = shared.y ?? domain([...seen.map((r) => r.y), ...(shift ? [shift] : [])], error.linear, 1.5);
  const exact = rows.some(isExact);
  // What is exact has no place on a logarithmic axis: it stands on a floor of its own.
  const floor = values[0] / (large ? 1.45 : 1.9);
  const yDomain = exact ? [floor / 1.3, values[1]] : [...values];
  if (shift && !error.linear) yDomain.splice(0, 2, Math.min(yDomain[0], shift / 1.3), Math.max(yDomain[1], shift * 1.3));
  rows.forEach((row) => (row.at = isExact(row) ? floor : row.y));
  const xDomain = domain(rows.map((r) => r.x), false, 1.35);
  const chains = d3.groups(rows, (r) => `${r.method} ${r.point.samples}`).map(([, chain]) => [...chain].sort(by((r) => r.x)));
  const steps = [];
  for (const row of best) steps.push(...(steps.length ? [{ x: row.x, at: steps.at(-1).at }] : []), row);
  const open = state.showPicture && ((row) => row.point.view != null && state.showPicture(row.point));
  return diagram({
    title: `from ${distance}`.replace("from rays", "rays"), small: large ? state.scene : "", rows, open,
    label: `${error.name} against ${cost.name}, ${state.scene} from ${distance}`,
    options: (width) => {
      const height = large ? Math.min(560, Math.max(340, width * 0.52)) : 232;
      const margins = { marginLeft: large ? 54 : 44, marginBottom: large ? 44 : 24, marginTop: large ? 22 : 8, marginRight: 18 };
      const { scales, marks } = axes({ width, height, margins, x: { domain: xDomain, label: large && titled(cost.name, unit) }, y: { domain: yDomain, linear: error.linear, reverse: error.larger, label: large && titled(error.name, error.unit) } });
      return {
        ...scales,
        color: { domain: unique(rows.map((r) => r.method)), range: unique(rows.map((r) => r.method)).map(colour) },
        symbol: { domain: unique(rows.map((r) => r.method)), range: unique(rows.map((r) => r.method)).map(symbol) },
        marks: [
          ...marks,
          steps.length > 1 ? Plot.line(steps, { x: "x", y: "at", stroke: "currentColor", strokeOpacity: 0.17, strokeWidth: large ? 10 : 8, strokeLinejoin: "round", strokeLinecap: "round" }) : null,
          exact ? Plot.ruleY([floor], { strokeOpacity: 0.35, strokeDasharray: "1 3" }) : null,
          exact ? Plot.text([floor], { frameAnchor: "left", y: (v) => v, text: () => (rows.some((r) => isExact(r) && r.y > 0) ? `no error, or below ${tick(Number(least.toPrecision(1)))}` : "no error"), dy: -7, dx: 4, fill: "currentColor", fillOpacity: 0.85, fontSize: 10.5 }) : null,
          shift ? Plot.ruleY([shift], { strokeDasharray: "7 4", strokeWidth: 1.6, strokeOpacity: 0.8 }) : null,
          shift && large ? Plot.text([shift], { frameAnchor: "right", y: (v) => v, text: () => "shift by half a pixel", dy: -7, dx: -4, fontSize: 11, fill: "currentColor" }) : null,
          ...chains.map((chain) => Plot.line(chain, { x: "x", y: "at", stroke: "method", strokeWidth: 1.4, strokeOpacity: 0.75 })),
          ...[false, true].map((filled) => Plot.dot(rows, { x: "x", y: "at", filter: (r) => r.onFront === filled, symbol: "method", stroke: "method", fill: filled ? "method" : "var(--ground)", r: large ? 5 : 4, strokeWidth: 1.7, className: "points", sort: null })),
          large ? Plot.text(rows.filter((r) => isOurs(r.method)), { x: "x", y: "at", text: (r) => knobOf(r.point), dy: -12, fontSize: 11, fill: "currentColor", stroke: "var(--ground)", strokeWidth: 3 }) : null,
        ].filter(Boolean),
      };
    },
  });
}
