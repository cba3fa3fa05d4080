// Cost and error by distance, and the energy's and the traffic's parts.

const QUALITY_1 = /(^|\W)delta 1($|[^\d.])/;
/** At each place the setting whose error is the nearest to that of ours there: one of all places would compare other errors at each. */
const NEAREST = "nearest to ours in error";

/** The setting of each method that these sections show. */
function settingsOf(points, chosen) {
  return new Map(unique(points.map((p) => p.method)).map((method) => {
    const own = unique(points.filter((p) => p.method === method).map((p) => p.setting));
    const settings = own.length > 1 && !isOurs(method) && pairedError(points) ? [NEAREST, ...own] : own;
    // By default quality 1, as in the paper.
    const usual = settings[0] === NEAREST ? NEAREST : settings.find((s) => QUALITY_1.test(s)) ?? settings[0];
    return [method, { settings, setting: settings.includes(chosen[method]) ? chosen[method] : usual }];
  }));
}

/** The error by which settings are paired: the first that ours has. */
const pairedError = (points) => errorMeasures().find((m) => points.some((p) => isOurs(p.method) && errorOf(p, m) > 0));

/** The points of the chosen settings. */
function shownOf(points, settings) {
  const error = pairedError(points);
  const isShown = (p) => p.setting === settings.get(p.method).setting;
  const ours = points.filter((p) => isOurs(p.method) && isShown(p));
  const off = (p) => {
    const same = ours.find((q) => place(q) === place(p) && q.samples === p.samples);
    const pair = same && [p, same].map((q) => errorOf(q, error));
    return pair?.every((v) => v > 0) ? Math.abs(Math.log(pair[0] / pair[1])) : Infinity;
  };
  const paired = points.filter((p) => settings.get(p.method).setting === NEAREST);
  const nearest = d3.rollups(paired, (of) => d3.least(of, off), (p) => p.method, (p) => place(p), (p) => p.samples).flatMap(([, of]) => of.flatMap(([, of]) => of.map(([, p]) => p)));
  return [...points.filter(isShown), ...nearest];
}

/** The full-resolution BVH of the same view. */
const baseOf = (rows, row) => rows.find((other) => other.method === "bvh" && other.place === row.place);

function distanceSection(section, state) {
  const body = h("div", {});
  const own = { cost: "milliseconds", error: null };
  const draw = () => {
    const points = state.points();
    const chosen = settingsOf(points, state.settings);
    const costs = COSTS.filter((c) => points.some((p) => c.of(p, costAt(p, state.machine)) != null));
    const cost = costs.find((c) => c.id === own.cost) ?? costs[0];
    const errors = errorMeasures().filter((m) => points.some((p) => errorOf(p, m) != null));
    const error = errors.find((m) => m.id === own.error) ?? errors[0];
    const shown = shownOf(points, chosen).filter((p) => p.distance != null);
    const unit = costUnit(cost, points, state.machine);
    const set = (key) => (value) => ((own[key] = value), draw());
    const controls = h(
      "div", { class: "controls" },
      choice("Cost", costs.map((c) => [c.id, titled(c.name, costUnit(c, points, state.machine))]), cost.id, set("cost")),
      error ? choice("Error", errors.map((m) => [m.id, titled(m.name, m.unit)]), error.id, set("error")) : null,
      [...chosen].filter(([, { settings }]) => settings.length > 1).map(([method, { settings, setting }]) => choice(`${method} at`, settings.map((s) => [s, s]), setting, (value) => ((state.settings[method] = value), state.changed()))),
    );
    const row = (p, y, more) => ({ x: p.distance, y, place: place(p), point: p, method: p.method, ...tipOf(p, more) });
    const costRows = shown.flatMap((p) => {
      const y = cost.of(p, costAt(p, state.machine));
      return y > 0 ? [row(p, y, [[cost.name, `${num(y)} ${unit}`]])] : [];
    });
    costRows.forEach((r) => {
      const base = baseOf(costRows, r);
      r.gain = base && base !== r ? base.y / r.y : null;
      if (r.gain != null) r.lines.push(["gain over bvh", times(r.gain)]);
    });
    const errorRows = error ? shown.flatMap((p) => (errorOf(p, error) == null ? [] : [row(p, errorOf(p, error), [[error.name, `${num(errorOf(p, error))} ${error.unit ?? ""}`]])])) : [];
    const methods = unique(costRows.map((r) => r.method));
    const label = shown.some((p) => p.byRadii === false) ? "distance of the eye from the origin" : "distance of the eye, bounding radii";
    const columns = (name) => [
      { name: "scene", value: (r) => r.point.scene }, { name: "distance", value: (r) => r.x }, { name: "method", value: (r) => r.method }, { name: "setting", value: (r) => r.point.setting }, { name, value: (r) => r.y },
    ];
    const few = unique(costRows.map((r) => r.x)).length < 2;
    body.replaceChildren(
      controls, keys(methods), few ? h("p", { class: "note" }, "All of these results are from one distance.") : "",
      h(
        "div", { class: "pair" },
        h("div", {}, lineDiagram(costRows, { title: `${titled(cost.name, unit)}`, small: `${state.scene}; beside points, where there is room, the gain over the full-resolution BVH`, x: label, state }), dataTable(`${cost.name} by distance, ${state.scene}`, [...columns(titled(cost.name, unit)), { name: "gain over bvh", value: (r) => r.gain, show: (r) => times(r.gain) }], costRows)),
        errorRows.length ? h("div", {}, lineDiagram(errorRows, { title: titled(error.name, error.unit), small: state.scene, x: label, linear: error.linear, isError: true, state }), dataTable(`${error.name} by distance, ${state.scene}`, columns(titled(error.name, error.unit)), errorRows)) : "",
      ),
    );
  };
  section.append(h("p", {}, "One setting of each method, all distances; where a method has several, at each the one whose error is the nearest to ours (the tip names it). A gain above 1 says by how much the method is cheaper than the quad-BVH over the full-resolution mesh."), body);
  state.onChange(draw);
}

function lineDiagram(rows, { title, small, x, linear, isError, state }) {
  const least = isError && !linear ? rounding(rows.map((r) => r.y)) : 0;
  const positive = linear ? rows : rows.filter((r) => r.y > least);
  const methods = unique(rows.map((r) => r.method));
  const exact = unique(rows.filter((r) => !linear && r.y <= least).map((r) => r.method));
  const [xDomain, yDomain] = [domain(positive.map((r) => r.x), false, 1.25), domain(positive.map((r) => r.y), linear, 1.9)];
  const figure = diagram({
    title, small, rows: positive, label: `${title} by distance, ${state.scene}`, open: state.showPicture && ((row) => row.point.view != null && state.showPicture(row.point)),
    options: (width) => {
      const height = Math.min(430, Math.max(300, width * 0.68));
      const placed = withRoom(positive, (r) => [Math.log(r.x / xDomain[0]) / Math.log(xDomain[1] / xDomain[0]) * (width - 82), linear ? 0 : (1 - Math.log(r.y / yDomain[0]) / Math.log(yDomain[1] / yDomain[0])) * (height - 62)]);
      const ticks = unique(positive.map((r) => Number(r.x.toPrecision(3)))).filter((v, k, all) => all.length < width / 44 || k % 2 === 0);
      const { scales, marks } = axes({ width, height, margins: { marginLeft: 56, marginBottom: 42, marginRight: 26, marginTop: 20 }, x: { domain: xDomain, ticks, label: x }, y: { domain: yDomain, linear } });
      return {
      ...scales,
      color: { domain: methods, range: methods.map(colour) },
      symbol: { domain: methods, range: methods.map(symbol) },
      marks: [
        ...marks,
        Plot.line(positive, { x: "x", y: "y", z: (r) => `${r.method} ${r.point.samples}`, stroke: "method", strokeWidth: 1.8, sort: "x" }),
        Plot.dot(positive, { x: "x", y: "y", symbol: "method", stroke: "method", fill: "method", r: 4.6, className: "points", sort: null }),
        ...[-13, 14].map((dy) => Plot.text(placed.filter((r) => r.dy === dy), { x: "x", y: "y", text: (r) => times(r.gain), dy, fontSize: 11.5, fontWeight: 600, fill: "method", stroke: "var(--ground)", strokeWidth: 3.5 })),
      ],
      };
    },
  });
  if (exact.length) figure.append(h("p", { class: "note" }, `${least > 0 && rows.some((r) => r.y > 0 && r.y <= least) ? `No error, or below ${tick(Number(least.toPrecision(1)))}` : "No error"}, at some distance: ${exact.join(", ")}.`));
  return figure;
}

/** Where gains have room: above their points or below them, ours first; a gain that has none is in the tip and in the table only. */
function withRoom(rows, at) {
  const taken = rows.map((r) => at(r)).map(([x, y]) => [x - 6, y - 6, x + 6, y + 6]);
  const own = new Map(rows.map((r, k) => [r, taken[k]]));
  const placed = [];
  for (const row of [...rows].filter((r) => r.gain != null).sort(by((r) => (isOurs(r.method) ? 0 : 1)))) {
    const [x, y] = at(row);
    const half = 3.6 * times(row.gain).length;
    for (const dy of [-13, 14]) {
      const box = [x - half, y + dy - 7, x + half, y + dy + 7];
      const meets = (other) => other !== own.get(row) && box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3];
      if (taken.some(meets)) continue;
      taken.push(box);
      placed.push({ ...row, dy });
      break;
    }
  }
  return placed;
}

/** The parts of the energy and of the traffic of one setting of each method. */
function partsSection(section, state) {
  const body = h("div", {});
  const draw = () => {
    const points = state.points();
    const chosen = settingsOf(points, state.settings);
    const shown = shownOf(points, chosen).filter((p) => costAt(p, state.machine));
    const unit = shown.map((p) => costAt(p, state.machine).energy.unit)[0] ?? "";
    const places = unique(shown.map(place));
    const parts = page.palette.parts.slice(0, ENERGY_PARTS.length).map((p) => p.name);
    const partColours = parts.map((p) => `var(--part-${p})`);
    const rowsOf = (points) => points.flatMap((p) => ENERGY_PARTS.map((part, k) => ({ point: p, label: p.samples > 1 ? `${p.method} ×${p.samples}` : p.method, part: parts[k], value: costAt(p, state.machine).energy[part], total: costAt(p, state.machine).energy.total })));
    const charts = places.map((where) => {
      const here = shown.filter((p) => place(p) === where);
      const rows = rowsOf(here);
      const bars = rows.map((r) => ({ ...r, x: r.value, y: 0, method: r.point.method, ...tipOf(r.point, [[`energy, ${r.part}`, `${num(r.value)} ${unit}`], ["of all", `${num((100 * r.value) / (r.total || 1))} %`], ["all", `${num(r.total)} ${unit}`]]) }));
      const totals = here.map((p) => ({ label: rowsOf([p])[0].label, total: costAt(p, state.machine).energy.total }));
      const labels = unique(rows.map((r) => r.label));
      return diagram({
        title: `from ${where}`.replace("from rays", "rays"), small: unit, rows: bars, label: `Energy by part from ${where}, ${state.scene}`,
        options: (width) => ({
          height: 34 + 27 * labels.length, marginLeft: 78, marginRight: 58, marginTop: 4, marginBottom: 26,
          x: { label: null, domain: [0, Math.max(...totals.map((t) => t.total)) || 1], ticks: Math.max(2, Math.floor(width / 110)), tickFormat: (v) => num(v) },
          y: { label: null, domain: labels, padding: 0.28 },
          color: { domain: parts, range: partColours },
          marks: [
            Plot.barX(bars, { x: "value", y: "label", fill: "part", className: "points", sort: null }),
            Plot.text(totals, { x: "total", y: "label", text: (t) => num(t.total), textAnchor: "start", dx: 5, fontSize: 11.5, fill: "currentColor" }),
            Plot.ruleX([0], { strokeOpacity: 0.5 }),
          ],
        }),
      });
    });
    const partKeys = swatchKeys("Parts", parts, (part) => `var(--part-${part})`);
    const columns = [
      { name: "from", value: (p) => place(p) }, { name: "method", value: (p) => p.method }, { name: "setting", value: (p) => p.setting }, { name: `energy (${unit})`, value: (p) => costAt(p, state.machine).energy.total },
      ...ENERGY_PARTS.map((part, k) => ({ name: parts[k], value: (p) => costAt(p, state.machine).energy[part] })),
      { name: "DRAM lines", value: (p) => costAt(p, state.machine).dram_lines }, { name: "DRAM bytes", value: (p) => costAt(p, state.machine).dram_bytes }, { name: "L1 requests for each ray", value: (p) => costAt(p, state.machine).l1_requests_per_ray },
    ];
    const kinds = shown.flatMap((p) => (costAt(p, state.machine).traffic?.kinds ?? []).map((kind) => ({ point: p, ...kind })));
    body.replaceChildren(timeBars(shown, state), h("h3", {}, "Energy"), partKeys, h("div", { class: "grid" }, charts), dataTable(`Energy and traffic, ${state.scene}`, columns, shown), traffic(kinds, state), limits(shown, state), overTime(shown, state));
  };
  section.append(h("p", {}, "The settings chosen above. Times and what runs over time have one axis everywhere; energy and traffic of every distance have an axis of their own, as far views take a small part of what near ones take."), body);
  state.onChange(draw);
}

/** Bytes by what lines hold, of results of simulations. */
function traffic(kinds, state) {
  if (!kinds.length) return "";
  const names = unique(kinds.map((k) => k.kind));
  const levels = [["l1", "L1s"], ["l2", "L2"], ["dram", "DRAM"]];
  const rows = kinds.flatMap((k) => levels.map(([id, level]) => ({ level, kind: k.kind, value: k.bytes_per_ray[id], point: k.point, place: place(k.point), method: k.point.method })));
  const charts = unique(rows.map((r) => r.place)).map((where) => {
    const here = rows.filter((r) => r.place === where).map((r) => ({ ...r, label: `${r.method}, ${r.level}`, x: r.value, y: 0, ...tipOf(r.point, [[`${r.kind}, ${r.level}`, `${num(r.value)} bytes for each ray`]]) }));
    const labels = unique(here.map((r) => r.label));
    return diagram({
      title: `from ${where}`.replace("from rays", "rays"), small: "bytes for each ray", rows: here, label: `Traffic by what lines hold from ${where}, ${state.scene}`,
      options: () => ({
        height: 34 + 21 * labels.length, marginLeft: 100, marginRight: 20, marginTop: 4, marginBottom: 26, x: { label: null, ticks: 3, tickFormat: (v) => num(v) }, y: { label: null, domain: labels, padding: 0.25 }, color: { domain: names, range: names.map(sectionFill) },
        marks: [Plot.barX(here, { x: "value", y: "label", fill: "kind", className: "points", sort: null }), Plot.ruleX([0], { strokeOpacity: 0.5 })],
      }),
    });
  });
  const kindKeys = swatchKeys("What lines hold", names, sectionFill);
  const columns = [
    { name: "from", value: (k) => place(k.point) }, { name: "method", value: (k) => k.point.method }, { name: "setting", value: (k) => k.point.setting }, { name: "lines hold", value: (k) => k.kind },
    { name: "L1 requests", value: (k) => k.l1 }, { name: "L2 requests", value: (k) => k.l2 }, { name: "DRAM lines", value: (k) => k.dram },
    ...levels.map(([id, level]) => ({ name: `bytes for each ray, ${level}`, value: (k) => k.bytes_per_ray[id] })),
  ];
  return h("div", {}, h("h3", {}, "Traffic by what lines hold"), kindKeys, h("div", { class: "grid" }, charts), dataTable(`Traffic by what lines hold, ${state.scene}`, columns, kinds));
}

/** Time and cycles of each method, all places on one axis. */
function timeBars(shown, state) {
  const longest = d3.max(shown, (p) => costAt(p, state.machine).milliseconds) || 1;
  const rows = shown.map((p) => {
    const { milliseconds, cycles } = costAt(p, state.machine);
    return { point: p, label: p.samples > 1 ? `${p.method} ×${p.samples}` : p.method, place: place(p), cycles, method: p.method, x: milliseconds, y: 0, ...tipOf(p, [["time", `${num(milliseconds)} ms`], ["cycles", num(cycles)]]) };
  });
  const charts = unique(rows.map((r) => r.place)).map((where) => {
    const here = rows.filter((r) => r.place === where);
    const methods = unique(here.map((r) => r.method));
    return diagram({
      title: `from ${where}`.replace("from rays", "rays"), small: "ms; cycles beside the bars", rows: here, label: `Time and cycles from ${where}, ${state.scene}`,
      options: (width) => ({
        height: 34 + 27 * here.length, marginLeft: 78, marginRight: 112, marginTop: 4, marginBottom: 26,
        x: { label: null, domain: [0, longest], ticks: Math.max(2, Math.floor(width / 130)), tickFormat: (v) => num(v) }, y: { label: null, domain: unique(here.map((r) => r.label)), padding: 0.28 }, color: { domain: methods, range: methods.map(colour) },
        marks: [
          Plot.barX(here, { x: "x", y: "label", fill: "method", className: "points", sort: null }),
          Plot.text(here, { x: "x", y: "label", text: (r) => `${num(r.x)} ms, ${tick(r.cycles)}`, textAnchor: "start", dx: 5, fontSize: 11.5, fill: "currentColor" }),
          Plot.ruleX([0], { strokeOpacity: 0.5 }),
        ],
      }),
    });
  });
  const columns = [
    { name: "from", value: (r) => r.place }, { name: "method", value: (r) => r.method }, { name: "setting", value: (r) => r.point.setting }, { name: "samples", value: (r) => r.point.samples },
    { name: "time (ms)", value: (r) => r.x }, { name: "cycles", value: (r) => r.cycles },
  ];
  return h("div", {}, h("h3", {}, "Time"), h("div", { class: "grid" }, charts), dataTable(`Time and cycles, ${state.scene}`, columns, rows));
}

/** Power over time, where results have it. */
function overTime(shown, state) {
  const runs = shown.filter((p) => costAt(p, state.machine).intervals?.some((i) => i.watts)).slice(0, 6);
  if (!runs.length) return "";
  // One axis of time and one of power for all.
  const end = d3.max(runs, (p) => costAt(p, state.machine).milliseconds);
  const most = d3.max(runs.flatMap((p) => costAt(p, state.machine).intervals), (i) => d3.sum(ENERGY_PARTS, (part) => i.watts?.[part] ?? 0));
  const parts = page.palette.parts.slice(0, ENERGY_PARTS.length).map((q) => q.name);
  const charts = runs.map((p) => {
    const c = costAt(p, state.machine);
    const ms = c.milliseconds / c.cycles;
    const rows = c.intervals.flatMap((i) => ENERGY_PARTS.map((part, k) => ({ from: (i.end - i.cycles) * ms, to: i.end * ms, x: i.end * ms, y: i.watts?.[part] ?? 0, part: page.palette.parts[k].name, ...tipOf(p, [[`power, ${page.palette.parts[k].name}`, `${num(i.watts?.[part] ?? 0)} W`], ["until", `${num(i.end * ms)} ms`]]) })));
    return diagram({
      title: `${p.method}, ${p.setting}`, small: `from ${place(p)}, W`, rows, label: `Power over time, ${p.method} ${p.setting}`,
      options: () => ({
        height: 220, marginLeft: 46, marginBottom: 38, x: { domain: [0, end], label: "time (ms)", labelAnchor: "center", labelArrow: "none", ticks: 3, tickFormat: (v) => num(v) }, y: { domain: [0, most || 1], label: null, grid: true, ticks: 4 }, color: { domain: parts, range: parts.map((q) => `var(--part-${q})`) },
        marks: [Plot.rectY(rows, Plot.stackY({ x1: "from", x2: "to", y: "y", fill: "part", inset: 0, className: "points" })), Plot.ruleY([0])],
      }),
    });
  });
  return h("div", {}, h("h3", {}, "Power over time"), swatchKeys("Parts", parts, (q) => `var(--part-${q})`), h("div", { class: "grid" }, charts));
}
