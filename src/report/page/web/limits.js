// What held the rays of a simulation, and what limited the machine.

/** Causes shown by name; those that hold less are one. */
const MOST_CAUSES = 7;
const REST = "all others";

/** Cycles that contexts had rays. */
const heldCycles = (stalls) => stalls.context_cycles - (stalls.cycles.idle ?? 0);

/** Shares of the rays' time by cause, and the limits: nothing where results have none. */
function limits(shown, state) {
  const runs = shown.map((point) => ({ point, cost: costAt(point, state.machine) })).filter(({ cost }) => cost.stalls && cost.roofline);
  if (!runs.length) return "";
  const share = ({ cost }, cause) => (cost.stalls.cycles[cause] ?? 0) / (heldCycles(cost.stalls) || 1);
  const causes = unique(runs.flatMap(({ cost }) => Object.keys(cost.stalls.cycles))).filter((cause) => cause !== "idle");
  causes.sort(by((cause) => -d3.sum(runs, (run) => share(run, cause))));
  const named = causes.length > MOST_CAUSES + 1 ? causes.slice(0, MOST_CAUSES) : causes;
  const names = named.length < causes.length ? [...named, REST] : named;
  const part = (run, name) => (name === REST ? d3.sum(causes.slice(named.length), (cause) => share(run, cause)) : share(run, name));
  const rows = runs.flatMap((run) => names.map((cause) => {
    const { point } = run;
    const value = 100 * part(run, cause);
    return { point, cause, value, place: place(point), label: point.method, x: value, y: 0, method: point.method, ...tipOf(point, [[cause, `${num(value)} % of the rays' cycles`]]) };
  }));
  const charts = unique(rows.map((r) => r.place)).map((where) => {
    const here = rows.filter((r) => r.place === where);
    const labels = unique(here.map((r) => r.label));
    return diagram({
      title: `from ${where}`.replace("from rays", "rays"), small: "% of the rays' cycles", rows: here, label: `What held the rays from ${where}, ${state.scene}`,
      options: () => ({
        height: 34 + 27 * labels.length, marginLeft: 78, marginRight: 20, marginTop: 4, marginBottom: 26, x: { label: null, domain: [0, 100], ticks: 5 }, y: { label: null, domain: labels, padding: 0.28 }, color: { domain: names, range: names.map(fillOf) },
        marks: [Plot.barX(here, { x: "value", y: "label", fill: "cause", className: "points", sort: null }), Plot.ruleX([0], { strokeOpacity: 0.5 })],
      }),
    });
  });
  const bounds = unique(runs.flatMap(({ cost }) => Object.keys(cost.roofline.limits)));
  const columns = [
    { name: "from", value: (r) => place(r.point) }, { name: "method", value: (r) => r.point.method }, { name: "setting", value: (r) => r.point.setting },
    { name: "nearest its bound", value: (r) => r.cost.roofline.largest }, ...bounds.map((name) => ({ name: `${name}, % of its bound`, value: (r) => 100 * (r.cost.roofline.limits[name]?.share ?? 0) })),
    { name: "holds most", value: (r) => r.cost.stalls.largest }, ...causes.map((cause) => ({ name: `${cause}, % of the rays' cycles`, value: (r) => 100 * share(r, cause) })),
    { name: "a ray's latency (cycles): median", value: (r) => r.cost.latencies?.rays.median }, { name: "its 99th percentile", value: (r) => r.cost.latencies?.rays.percentile_99 }, { name: "its largest", value: (r) => r.cost.latencies?.rays.largest },
  ];
  return h("div", {}, h("h3", {}, "What held the rays"), swatchKeys("Causes", names, fillOf), h("div", { class: "grid" }, charts), dataTable(`Limits and causes, ${state.scene}`, columns, runs), phases(runs), limitsOverTime(runs));
}

/** How full the blocks of traversal units were: the share of time with a load of nine tenths or more, a line at the mean load. */
function phases(all) {
  const runs = all.filter(({ cost }) => cost.units?.phases);
  if (!runs.length) return "";
  const share = (value) => `${num(100 * value)} % of the units’ time`;
  const rows = runs.flatMap(({ point, cost }) => Object.entries(cost.units.phases.blocks).filter(([block]) => cost.units.blocks[block]?.operations > 0).map(([block, of]) => {
    const eased = cost.units.eased?.[block];
    return { point, block, of, eased, cycles: cost.cycles, run: `${point.method}, ${point.setting}, from ${place(point)}`, x: 100 * of.full, y: 0, load: 100 * of.load, method: point.method, ...tipOf(point, [[block, `full for ${share(of.full)}`], ["the fullest", share(of.fullest)], ["mean load", `${num(100 * of.load)} %`], ...(eased == null ? [] : [["cycles if it kept no ray waiting", `${num(eased)} of ${num(cost.cycles)}`]])]) };
  }));
  const charts = unique(rows.map((r) => r.run)).slice(0, 6).map((run) => {
    const here = rows.filter((r) => r.run === run);
    return diagram({
      title: run, small: "% of the units’ time", rows: here, label: `How full the blocks of units were, ${run}`,
      options: () => ({
        height: 34 + 24 * here.length, marginLeft: 96, marginRight: 20, marginTop: 4, marginBottom: 26, x: { label: null, domain: [0, 100], ticks: 5 }, y: { label: null, domain: here.map((r) => r.block), padding: 0.3 }, color: { domain: here.map((r) => r.block), range: here.map((r) => fillOf(r.block)) },
        marks: [Plot.barX(here, { x: "x", y: "block", fill: "block", className: "points", sort: null }), Plot.tickX(here, { x: "load", y: "block", strokeWidth: 2 }), Plot.ruleX([0], { strokeOpacity: 0.5 })],
      }),
    });
  });
  const columns = [
    { name: "from", value: (r) => place(r.point) }, { name: "method", value: (r) => r.point.method }, { name: "setting", value: (r) => r.point.setting }, { name: "block", value: (r) => r.block },
    { name: "mean load, %", value: (r) => r.load }, { name: "full, % of the units’ time", value: (r) => r.x }, { name: "of the unit with least", value: (r) => 100 * r.of.full_of_units[0] }, { name: "of the unit with most", value: (r) => 100 * r.of.full_of_units[1] },
    { name: "the fullest, %", value: (r) => 100 * r.of.fullest }, { name: "cycles if it kept no ray waiting", value: (r) => r.eased }, { name: "cycles", value: (r) => r.cycles },
  ];
  return h("div", {}, h("h3", {}, "How full the blocks of units were"), h("p", { class: "note" }, "Bars: the time with a load of 90 % or more, by stretches of 1,024 cycles of each unit; lines: the mean load."), h("div", { class: "grid" }, charts), dataTable("Blocks of units", columns, rows));
}

/** The limit that was nearest its bound in each stretch of time. */
function limitsOverTime(all) {
  const runs = all.filter(({ cost }) => cost.intervals.length > 1 && cost.intervals.every((i) => i.limit)).slice(0, 6);
  if (!runs.length) return "";
  const names = unique(runs.flatMap(({ cost }) => cost.intervals.map((i) => i.limit)));
  // One axis of time for all: who takes longer is wider.
  const end = d3.max(runs, ({ cost }) => cost.milliseconds);
  const charts = runs.map(({ point, cost }) => {
    const ms = cost.milliseconds / cost.cycles;
    const rows = cost.intervals.map((i) => ({ from: (i.end - i.cycles) * ms, to: i.end * ms, x: i.end * ms, y: 100 * i.limit_share, limit: i.limit, ...tipOf(point, [[i.limit, `${num(100 * i.limit_share)} % of its bound`], ["until", `${num(i.end * ms)} ms`]]) }));
    return diagram({
      title: `${point.method}, ${point.setting}`, small: `from ${place(point)}, % of its bound`, rows, label: `The largest limit over time, ${point.method} ${point.setting}`,
      options: () => ({
        height: 220, marginLeft: 46, marginBottom: 38, x: { domain: [0, end], label: "time (ms)", labelAnchor: "center", labelArrow: "none", ticks: 3, tickFormat: (v) => num(v) }, y: { label: null, grid: true, ticks: 4, domain: [0, 100] }, color: { domain: names, range: names.map(fillOf) },
        marks: [Plot.rectY(rows, { x1: "from", x2: "to", y: "y", fill: "limit", inset: 0, className: "points" }), Plot.ruleY([0])],
      }),
    });
  });
  return h("div", {}, h("h3", {}, "The largest limit over time"), swatchKeys("Limits", names, fillOf), h("div", { class: "grid" }, charts));
}
