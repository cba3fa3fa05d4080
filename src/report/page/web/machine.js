// Costs over any key of the machines that results are of.

/** The numbers of a machine's description, by key, as --set names them. */
function machineKeys(description, before = "") {
  return Object.assign({}, ...Object.entries(description ?? {}).map(([key, value]) => {
    const name = before + key;
    return typeof value === "number" ? { [name]: value } : value && typeof value === "object" ? machineKeys(value, `${name}.`) : {};
  }));
}

/** Keys of which there are several values. */
function variedKeys(points) {
  const values = new Map();
  for (const { keys } of points.flatMap((p) => p.costs)) for (const [key, value] of Object.entries(keys ?? {})) values.set(key, (values.get(key) ?? new Set()).add(value));
  return [...values].filter(([, of]) => of.size > 1).map(([key]) => key).sort();
}

function machineSection(section, state) {
  const body = h("div", {});
  const own = { key: null, cost: "milliseconds" };
  const draw = () => {
    const points = state.all.filter((p) => p.scene === state.scene && (state.samples === "all" || p.samples === Number(state.samples))).sort(by((p) => p.distance ?? 0));
    const keysHere = variedKeys(points);
    if (!keysHere.length) return body.replaceChildren(h("p", { class: "note" }, "The machines of this scene's results differ in no number."));
    if (!keysHere.includes(own.key)) own.key = keysHere[0];
    const costs = COSTS.filter((c) => points.some((p) => p.costs.some((m) => c.of(p, m) != null)));
    const cost = costs.find((c) => c.id === own.cost) ?? costs[0];
    const unit = cost.energy ? points.flatMap((p) => p.costs.map((c) => c.energy.unit))[0] ?? "" : cost.unit;
    // A line is of machines that are the same but for the key.
    const rest = (c) => JSON.stringify([c.compute, ...keysHere.filter((key) => key !== own.key).map((key) => c.keys?.[key] ?? null)]);
    const rows = points.flatMap((p) => p.costs.flatMap((c) => {
      const [x, y] = [c.keys?.[own.key], cost.of(p, c)];
      return x == null || !(y > 0) ? [] : [{ x, y, point: p, method: p.method, place: place(p), machine: c.target, line: JSON.stringify([p.method, p.setting, p.samples, rest(c)]), ...tipOf(p, [["machine", c.target], [own.key, num(x)], [cost.name, `${num(y)} ${unit}`]]) }];
    }));
    const linear = rows.some((r) => r.x <= 0);
    const [xDomain, yDomain] = [domain(rows.map((r) => r.x), linear), domain(rows.map((r) => r.y), false)];
    const methods = unique(rows.map((r) => r.method));
    const ticks = unique(rows.map((r) => r.x)).sort(d3.ascending);
    const charts = unique(rows.map((r) => r.place)).map((where) => {
      const here = rows.filter((r) => r.place === where);
      return diagram({
        title: `from ${where}`.replace("from rays", "rays"), small: titled(cost.name, unit), rows: here, label: `${cost.name} over ${own.key} from ${where}, ${state.scene}`,
        options: (width) => {
          const height = Math.min(320, Math.max(240, width * 0.6));
          const { scales, marks } = axes({ width, height, margins: { marginLeft: 56, marginBottom: 42, marginRight: 22, marginTop: 12 }, x: { domain: xDomain, linear, label: own.key, ticks: ticks.length < width / 60 ? ticks : undefined }, y: { domain: yDomain } });
          return {
            ...scales, color: { domain: methods, range: methods.map(colour) }, symbol: { domain: methods, range: methods.map(symbol) },
            marks: [
              ...marks,
              Plot.line(here, { x: "x", y: "y", z: "line", stroke: "method", strokeWidth: 1.6, sort: "x" }),
              Plot.dot(here, { x: "x", y: "y", symbol: "method", stroke: "method", fill: "method", r: 4.4, className: "points", sort: null }),
            ],
          };
        },
      });
    });
    const set = (key) => (value) => ((own[key] = value), draw());
    const columns = [
      { name: "from", value: (r) => r.place }, { name: "method", value: (r) => r.method }, { name: "setting", value: (r) => r.point.setting }, { name: "machine", value: (r) => r.machine },
      { name: own.key, value: (r) => r.x }, { name: titled(cost.name, unit), value: (r) => r.y },
    ];
    body.replaceChildren(
      h("div", { class: "controls" }, choice("Machine’s key", keysHere.map((key) => [key, key]), own.key, set("key")), choice("Cost", costs.map((c) => [c.id, titled(c.name, c.energy ? unit : c.unit)]), cost.id, set("cost"))),
      keys(methods), h("div", { class: "grid" }, charts), dataTable(`${cost.name} over ${own.key}, ${state.scene}`, columns, rows),
    );
  };
  section.append(h("p", {}, "Any number in which the machines differ, rightward; all diagrams have the same axes. A line joins machines that differ in that number alone."), body);
  state.onChange(draw);
}
