// The verdict: which method is the cheapest at each view, ours or not, and how far ours is behind or ahead.

/** Sizes of frames in words. */
const sizeWords = (sizes) => unique(sizes.filter(Boolean).map((size) => size.join(" × "))).join(", ");

/** What is of the whole frame, and what of some of its columns and rows. */
function sizesNote() {
  const doc = page.error_time;
  const few = unique(doc.views.map((v) => (v.every > 1 ? `every ${ordinal(v.every)} column and row (${v.size.map((n) => Math.floor(n / v.every)).join(" × ")} pixels)` : "all its pixels")));
  return h("p", { class: "note", id: "sizes" }, `Costs are those of whole frames of ${sizeWords(doc.views.map((v) => v.size))} pixels. Errors, in pixels of that frame, and pictures are of ${few.join(", ")}: each is a ray of the frame, with its own cone.`);
}

const ordinal = (n) => `${n}${n % 100 > 10 && n % 100 < 14 ? "th" : ({ 1: "st", 2: "nd", 3: "rd" }[n % 10] ?? "th")}`;

function verdictSection(section) {
  for (const verdict of page.verdicts) {
    section.append(h("h3", {}, verdict.head), h("ul", { class: "said" }, verdict.said.map((words) => h("li", {}, words))), scrolled(`Winners: ${verdict.head}`, winnersTable(verdict)));
  }
}

/** The map of winners. */
function winnersTable({ head, rows }) {
  const columns = d3.max(rows, (row) => row.winners.length);
  const cell = (row, w) => {
    const who = w.best ?? (w.over_ours == null ? "none" : "the same");
    const paint = w.best ? colour(w.best) : "var(--soft)";
    const title = [w.setting, w.note].filter(Boolean).join("; ");
    return h(
      "td", { class: "winner", style: `--method:${paint}`, title: title || null, "data-view": w.view, "data-cost": row.cost, "data-best": w.best, "data-value": w.over_ours },
      h("small", {}, `${num(w.distance)} radii`), h("span", {}, w.best ? swatch(w.best) : "", who), h("strong", {}, w.over_ours == null ? "" : w.over_ours < 9.995 ? w.over_ours.toFixed(2) : num(Math.round(w.over_ours))),
    );
  };
  const body = d3.groups(rows, (row) => row.scene).flatMap(([scene, of]) => of.map((row, k) => h(
    "tr", {},
    k === 0 ? h("th", { scope: "rowgroup", rowspan: of.length }, scene) : "", h("th", { scope: "row" }, row.words),
    row.winners.map((w) => cell(row, w)), d3.range(row.winners.length, columns).map(() => h("td", {})),
  )));
  return h(
    "table", { class: "winners" },
    h("caption", { class: "visually-hidden" }, `Winners: ${head}`),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "scene"), h("th", { scope: "col" }, "cost"), h("th", { scope: "col", colspan: columns }, "from near to far: the cheapest method, and the cheapest other’s cost over lod’s (below 1 lod is behind)"))),
    h("tbody", {}, body),
  );
}

/** Costs of every other method over ours, one for each view: at half a pixel of error where that was measured, and else at the settings shown by distance. */
function ratiosToOurs(state) {
  const doc = page.error_time;
  const here = doc?.equal_error.filter((e) => doc.scenes[doc.views[e.view].scene].name === state.scene && e.error === "surface-p99" && e.level === 0.5 && state.machine === target([doc.machines[e.machine].label, ...doc.machines[e.machine].set].join(" "), e.compute)) ?? [];
  if (here.length) {
    const fewest = d3.min(here, (e) => e.samples);
    return here.filter((e) => e.samples === fewest).flatMap((e) => e.methods.filter((m) => m.ratio != null).map((m) => ({ cost: e.cost, method: m.method, ratio: m.ratio })));
  }
  const points = state.points();
  const shown = shownOf(points, settingsOf(points, {}));
  const fewest = d3.min(shown, (p) => p.samples);
  const ours = shown.filter((p) => isOurs(p.method) && p.samples === fewest);
  return [["milliseconds", "time"], ["energy.total", "energy"], ["dram_lines", "dram-lines"]].flatMap(([id, cost]) => {
    const of = (p) => COSTS.find((c) => c.id === id).of(p, costAt(p, state.machine));
    return ours.flatMap((p) => shown.filter((q) => !isOurs(q.method) && q.samples === fewest && place(q) === place(p) && of(p) > 0 && of(q) > 0).map((q) => ({ cost, method: q.method, ratio: of(q) / of(p) })));
  });
}

/** Each cost of every other method over ours, at a glance. */
function glance(state) {
  const list = h("ul", { class: "glance" });
  const draw = () => {
    const ratios = ratiosToOurs(state);
    const equal = page.error_time?.equal_error.length ? "within half a pixel of the surface" : "at the settings by distance";
    const line = ([method, of]) => {
      const [least, most] = d3.extent(of, (r) => r.ratio);
      const range = times(least) === times(most) ? times(most) : `${times(least)} to ${times(most)}`;
      return h("span", { "data-method": method }, swatch(method), h("span", {}, `${method} `, h("b", {}, range), `, above 1 in ${of.filter((r) => r.ratio > 1).length} of ${count(of.length, "view")}`));
    };
    const cards = [["time", "Time"], ["energy", "Energy"], ["dram-lines", "DRAM lines"]].flatMap(([cost, name]) => {
      const of = d3.groups(ratios.filter((r) => r.cost === cost), (r) => r.method);
      return of.length ? [h("li", { "data-cost": cost }, h("strong", {}, `${name} over ours`), h("span", {}, `${state.scene}, ${sizeWords(state.points().map((p) => p.size))}, ${equal}`), of.map(line))] : [];
    });
    const surface = errorMeasures().find((m) => m.id === "geometry.surface.percentile_99");
    const points = state.points();
    const ours = shownOf(points, settingsOf(points, {})).filter((p) => isOurs(p.method) && errorOf(p, surface) != null);
    if (ours.length) cards.push(h("li", {}, h("strong", {}, `${num(d3.max(ours, (p) => errorOf(p, surface)), 2)} pixels`), h("span", {}, `ours is off the surface at the 99th percentile, at ${unique(ours.map((p) => p.setting)).join(", ")}, the most of ${count(unique(ours.map(place)).length, "view")}`)));
    list.replaceChildren(...cards);
  };
  state.onChange(draw);
  return list;
}

/** What the others cost over ours, by the size of the frame. */
function sizeSection(section, state) {
  const doc = page.error_time;
  const body = h("div", {});
  const own = { view: null };
  const names = [["time", (c) => c.milliseconds], ["energy", (c) => c.energy.total], ["DRAM lines", (c) => c.dram_lines]];
  const draw = () => {
    const measured = doc.sizes.flatMap((s) => {
      const view = doc.views[s.view];
      const costs = s.costs.find((c) => target([doc.machines[c.machine].label, ...doc.machines[c.machine].set].join(" "), c.compute) === state.machine);
      return costs && doc.scenes[view.scene].name === state.scene ? [{ ...s, distance: view.distance, costs }] : [];
    }).sort(by((s) => s.distance));
    const views = unique(measured.map((s) => s.view));
    own.view = views.includes(own.view) ? own.view : views[0];
    const all = measured.filter((s) => s.view === own.view);
    const ours = (s) => all.find((o) => isOurs(o.method) && String(o.size) === String(s.size));
    const rows = names.map(([name, of]) => all.filter((s) => !isOurs(s.method) && ours(s)).map((s) => {
      const ratio = of(s.costs) / of(ours(s).costs);
      const point = { scene: state.scene, distance: s.distance, method: s.method, setting: s.setting, samples: 1 };
      return { x: s.size[0], y: ratio, gain: ratio, name, size: s.size, ours: ours(s).setting, place: s.size.join(" × "), point, method: s.method, ...tipOf(point, [["frame", s.size.join(" × ")], [`${name} over ours`, times(ratio)]]) };
    }));
    if (!rows[0].length) return body.replaceChildren(h("p", { class: "note" }, "Not measured for this scene and machine."));
    const columns = [{ name: "columns", value: (r) => r.size[0] }, { name: "rows", value: (r) => r.size[1] }, { name: "method", value: (r) => r.method }, { name: "setting", value: (r) => r.point.setting }, { name: "ours", value: (r) => r.ours }, { name: "cost", value: (r) => r.name }, { name: "over ours", value: (r) => r.y, show: (r) => num(r.y, 4) }];
    body.replaceChildren(
      ...(views.length > 1 ? [h("div", { class: "controls" }, choice("Distance", views.map((view) => [view, `${num(doc.views[view].distance)} radii`]), own.view, (view) => ((own.view = Number(view)), draw())))] : []),
      keys(unique(rows[0].map((r) => r.method))),
      h("div", { class: "triple" }, rows.map((of) => lineDiagram(of, { title: `${of[0].name} over ours`, small: `${state.scene} from ${num(all[0].distance)} radii, ${sizeWords(all.map((s) => s.size))}`, x: "columns of the frame", state }))),
      dataTable(`Costs over ours by size, ${state.scene}, ${num(all[0].distance)} radii`, columns, rows.flat()),
    );
  };
  section.append(h("p", {}, "The same view in frames of several sizes, each method as it is by default: ours at delta 1, discrete at the level that its own rule chooses. Above 1 ours is cheaper. Fewer pixels mean coarser levels of detail, and the same full resolution."), body);
  state.onChange(draw);
}
