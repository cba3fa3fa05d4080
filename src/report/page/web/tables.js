// The sections that are tables.

function equalSection(section, state) {
  const doc = page.error_time;
  const body = h("div", {});
  const own = { error: null, level: null, cost: null };
  const words = (id) => page.measures[id] ?? id;
  const draw = () => {
    const all = doc.equal_error.map((e) => ({ ...e, v: doc.views[e.view], target: target([doc.machines[e.machine].label, ...doc.machines[e.machine].set].join(" "), e.compute) })).filter((e) => doc.scenes[e.v.scene].name === state.scene && e.target === state.machine && (state.samples === "all" || e.samples === Number(state.samples)));
    if (!all.length) return body.replaceChildren(h("p", { class: "note" }, "None for this scene and machine."));
    const pick = (key, values) => (own[key] = values.map(String).includes(String(own[key])) ? own[key] : values[0]);
    const errors = unique(all.map((e) => e.error));
    pick("error", errors);
    const levels = unique(all.filter((e) => e.error === own.error).map((e) => e.level)).sort(by(Number));
    pick("level", levels);
    const costs = unique(all.map((e) => e.cost));
    pick("cost", costs);
    const rows = all.filter((e) => e.error === own.error && e.level === Number(own.level) && e.cost === own.cost).sort(by((e) => e.v.distance));
    const others = ["methods", "own_rule"].flatMap((list) => unique(rows.flatMap((e) => e[list].map((m) => m.method))).map((method) => ({ name: list === "methods" ? method : `${method}, own rule`, of: (e) => e[list].find((m) => m.method === method) })));
    const set = (key) => (value) => ((own[key] = value), draw());
    const why = (words) => (words ? h("span", { class: "why" }, words) : "");
    /** A cost, the setting that has it, and what is to be said of it. */
    const cost = (of) => (of?.cost == null ? why(of?.why ?? "–") : [num(of.cost, 4), why(of.setting), why(of.why)]);
    const columns = [
      { name: "from (radii)", value: (e) => e.v.distance }, { name: "samples", value: (e) => e.samples }, { name: "lod", value: (e) => e.ours, show: (e) => cost({ ...e, cost: e.ours }) },
      ...others.flatMap(({ name, of }) => [
        { name, value: (e) => of(e)?.cost ?? null, show: (e) => cost(of(e)) },
        { name: "over lod", value: (e) => of(e)?.ratio ?? null, show: (e) => (of(e)?.ratio == null ? "–" : h("span", { class: of(e).ratio > 1 ? "better" : "" }, times(of(e).ratio))) },
      ]),
    ];
    const name = `At equal error, ${words(own.error)} ${own.level}: ${words(own.cost)}, ${state.scene}, ${sizeWords(all.map((e) => e.v.size))}`;
    body.replaceChildren(
      h("div", { class: "controls" }, choice("Error", errors.map((e) => [e, words(e)]), own.error, set("error")), choice("Level", levels.map((l) => [l, num(l)]), own.level, set("level")), choice("Cost", costs.map((c) => [c, words(c)]), own.cost, set("cost"))),
      h("h3", {}, name),
      scrolled(name, table(name, columns, rows)),
      h("div", { class: "data" }, h("button", { type: "button", "aria-label": `CSV of: ${name}`, onclick: () => save("equal-error.csv", "text/csv", csv(columns, rows)) }, "CSV")),
    );
  };
  section.append(h("p", {}, "What each method costs where its error is at most the one chosen. Delta can have any value: our cost is interpolated between the values that were measured, never outside of them. Discrete LOD has the cheapest of its levels that is near enough, as if one knew its error beforehand; its own rule chooses the level without that, and its column says where that is further off. A ratio above 1, in bold, is how many times as much as ours a method costs."), body);
  state.onChange(draw);
}

function leftOutSection(section, state) {
  const doc = page.error_time;
  const body = h("div", {});
  const draw = () => {
    const all = doc.left_out.map((l) => {
      const costs = l.point.costs.find((c) => target([doc.machines[c.machine].label, ...doc.machines[c.machine].set].join(" "), c.compute) === state.machine);
      return { ...l, v: doc.views[l.point.view], costs };
    }).filter((l) => l.costs && doc.scenes[l.v.scene].name === state.scene).sort(by((l) => l.v.distance));
    if (!all.length) return body.replaceChildren(h("p", { class: "note" }, "None for this scene and machine."));
    const whole = (l) => all.find((other) => other.point.view === l.point.view && other.what === "whole");
    const over = (of) => ({ value: (l) => of(l) / of(whole(l)), show: (l) => num(of(l) / of(whole(l)), 3) });
    const columns = [
      { name: "from (radii)", value: (l) => l.v.distance }, { name: "left out", value: (l) => l.what }, { name: "zero bits of coordinates", value: (l) => l.coordinate_zeros }, { name: "of directions", value: (l) => l.direction_zeros },
      { name: "surface error, pixels, 99th percentile", value: (l) => l.point.geometry.surface?.percentile_99 }, { name: "largest", value: (l) => l.point.geometry.surface?.maximum },
      { name: "gate equivalents of a unit", value: (l) => l.costs.unit_gates }, { name: "bytes a finest triangle", value: (l) => l.point.bytes_per_triangle, show: (l) => num(l.point.bytes_per_triangle, 3) },
      { name: "time over whole", ...over((l) => l.costs.cycles) }, { name: "energy over whole", ...over((l) => l.costs.energy.total) },
    ];
    const name = `Left out, ${state.scene}`;
    body.replaceChildren(
      scrolled(name, table(name, columns, all)),
      h("div", { class: "data" }, h("button", { type: "button", "aria-label": `CSV of: ${name}`, onclick: () => save("left-out.csv", "text/csv", csv(columns, all)) }, "CSV")),
    );
  };
  section.append(h("p", {}, "The same view at delta 1: with the whole scene on the machine's own units; with only what its rays read, on units for that, every hit the same; and on the coarsest grids on which nothing moves by more than so many pixels. Errors are against full resolution of the whole scene, so those of the first two are delta's."), body);
  state.onChange(draw);
}

function stabilitySection(section) {
  for (const report of page.stability) {
    const rows = [...report.rows.map((r) => ({ name: r.case, ...r })), ...(report.hunt ? [{ name: "hunt", ...report.hunt }] : [])];
    const n = (name, key) => ({ name, value: (r) => r[key] });
    const breaches = d3.sum(rows, (r) => r.misses + r.doubles + r.different + r.overflows + r.saturated);
    const columns = [
      { name: "case", value: (r) => r.name }, { name: "what is hard about it", value: (r) => r.about ?? "counterexamples hunted for" }, n("rays", "rays"), n("balanced", "balanced"), n("compared", "compared"), n("misses", "misses"), n("double hits", "doubles"), n("different", "different"),
      { name: "overflows", value: (r) => (report.widths_checked ? r.overflows + r.saturated : null) }, n("t, ulp", "t_ulp"), n("barycentric, ulp", "bary_ulp"), n("pixels", "pixels"),
    ];
    section.append(
      h("p", {}, `${count(d3.sum(rows, (r) => r.rays), "ray")} of seed ${report.seed}: `, h("strong", {}, breaches === 0 ? "no breach" : count(breaches, "breach", "breaches")), report.widths_checked ? "." : "; this build did not look for overflows.", " Compared: against exact arithmetic."),
      scrolled("Stability by case", table("Stability by case", columns, rows)),
      h("div", { class: "data" }, h("button", { type: "button", "aria-label": "CSV of: stability", onclick: () => save("stability.csv", "text/csv", csv(columns, rows)) }, "CSV")),
    );
  }
}

/** Code between backticks, and the rest as it is. */
const inline = (text) => text.split("`").map((part, k) => (k % 2 ? h("code", {}, part) : part));

function ledgerSection(section) {
  for (const { title, head, rows } of page.ledger) {
    section.append(h("h3", {}, title), scrolled(`Claims: ${title}`, h("table", { class: "words" }, h("caption", { class: "visually-hidden" }, title), h("thead", {}, h("tr", {}, head.map((c) => h("th", { scope: "col" }, inline(c))))), h("tbody", {}, rows.map((row) => h("tr", {}, row.map((c) => h("td", {}, inline(c)))))))));
  }
}

function runSection(section) {
  const facts = (pairs) => h("dl", { class: "facts" }, pairs.filter(([, b]) => b != null && b !== "").map(([a, b]) => [h("dt", {}, a), h("dd", {}, b)]));
  const quote = (word) => (/^[\w.,:=\/+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  // Of many, one below the other would hide what comes after.
  const cards = page.runs.map((run) => {
    const inputs = run.inputs.map((i) => h("div", {}, h("code", {}, i.name), ...(i.xxh3 ? [`, ${num(i.bytes)} bytes, XXH3 `, h("code", {}, i.xxh3)] : [", a pipe"])));
    return h("div", { class: "card" }, facts([["command", h("code", {}, ["lodray", run.command, ...run.arguments].map(quote).join(" "))], ["version", run.lodray], ["inputs", inputs.length ? inputs : null], ["notes", run.notes?.length ? run.notes.map((n) => h("div", {}, n)) : null]]));
  });
  section.append(...(cards.length > 4 ? [h("details", {}, h("summary", {}, count(cards.length, "run")), cards)] : cards));
  if (page.documents.length) section.append(h("h3", {}, "What this page shows"), h("div", { class: "card" }, facts(page.documents.map((d) => [d.kind, [h("code", {}, d.name), `, ${num(d.bytes)} bytes, XXH3 `, h("code", {}, d.xxh3)]]))));
  const doc = page.error_time;
  if (doc) {
    const o = doc.options;
    section.append(h("h3", {}, "Error against cost"), h("div", { class: "card" }, facts([["program", doc.program], ["frames", sizeWords(doc.views.map((v) => v.size))], ["errors and pictures", unique(doc.views.map((v) => v.size.map((n) => Math.floor(n / v.every)).join(" × "))).join(", ") + " of their pixels"], ["samples per pixel", o.samples.join(", ")], ["shading", o.shading], ["FLIP", `${num(o.pixels_per_degree, 4)} pixels per degree`], ["nearest surface", `one ray in ${o.nearest_stride}`]])));
    section.append(scrolled("Scenes", table("Scenes", [["scene", "name"], ["file", "file"], ["hash", "hash"], ["splits", "levels"], ["base triangles", "base_triangles"], ["finest triangles", "finest_triangles"], ["bounds", "bounds"]].map(([name, key]) => ({ name, value: (s) => s[key] })), doc.scenes)));
    section.append(scrolled("Methods", table("Methods", [["method", "name"], ["knob", "knob"], ["what it is", "help"]].map(([name, key]) => ({ name, value: (m) => m[key] })), doc.methods)));
  }
  const machines = new Map([...(doc?.machines ?? []), ...page.simulations.map((s) => s.result.setup.machine)].map((m) => [[m.label, ...m.set].join(" "), m.description]));
  for (const [name, description] of machines) section.append(h("details", {}, h("summary", {}, `Machine ${name}`), h("pre", { class: "scroll", tabindex: "0", role: "region", "aria-label": `Machine ${name}`, style: "padding:.7rem" }, JSON.stringify(description, null, 2))));
}
