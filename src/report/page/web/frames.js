// Frames after one another, each with the caches as the ones before left them.

/** What a frame takes, by name; energy has the result's unit. */
const FRAME_COSTS = [
  ["cycles", "cycles"], ["energy", "energy"], ["dram_bytes", "DRAM bytes"], ["l1_requests", "requests to the L1s"], ["l1_misses", "misses of the L1s"], ["l2_misses", "misses of the L2"], ["stragglers", "share with rays in fewer than half of the contexts"],
];

const ofSeveralFrames = () => page.simulations.filter(({ result }) => result.frames.length > 1);

function framesSection(section) {
  const body = h("div", {});
  let cost = FRAME_COSTS[0][0];
  const draw = () => {
    const rows = ofSeveralFrames().flatMap(({ scene, result }, run) => {
      const { setup } = result;
      const [name, method] = [scene ?? setup.scene.name, setup.method.name];
      const title = [method, settingOf(setup.method)].join(", ");
      const machine = target([setup.machine.label, ...setup.machine.set].join(" "), setup.compute);
      return result.frames.map((frame, k) => ({ x: k + 1, y: frame[cost], frame, run, name, method, machine, setting: settingOf(setup.method), unit: result.energy.unit, title, lines: [["scene", name], ["machine", machine], ["frame", num(k + 1)], ...FRAME_COSTS.map(([key, what]) => [key === "energy" ? titled(what, result.energy.unit) : what, num(frame[key])]), ...(frame.before ? [["cycles before its rays", num(frame.before.cycles)]] : [])] }));
    });
    const methods = unique(rows.map((r) => r.method));
    const units = unique(rows.map((r) => r.unit)).join(" or ");
    const shown = titled(FRAME_COSTS.find(([key]) => key === cost)[1], cost === "energy" ? units : "");
    const charts = unique(rows.map((r) => r.name)).map((name) => {
      const here = rows.filter((r) => r.name === name);
      return diagram({
        title: name, small: shown, rows: here, label: `${shown} of each frame, ${name}`,
        options: (width) => {
          const height = Math.min(320, Math.max(240, width * 0.6));
          const { scales, marks } = axes({ width, height, margins: { marginLeft: 62, marginBottom: 42, marginRight: 22, marginTop: 12 }, x: { domain: [0.5, (d3.max(here, (r) => r.x) ?? 1) + 0.5], linear: true, label: "frame" }, y: { domain: [0, 1.08 * (d3.max(here, (r) => r.y) || 1)], linear: true } });
          return {
            ...scales, color: { domain: methods, range: methods.map(colour) }, symbol: { domain: methods, range: methods.map(symbol) },
            marks: [...marks, Plot.line(here, { x: "x", y: "y", z: "run", stroke: "method", strokeWidth: 1.6 }), Plot.dot(here, { x: "x", y: "y", symbol: "method", stroke: "method", fill: "method", r: 4.4, className: "points", sort: null })],
          };
        },
      });
    });
    const columns = [
      { name: "scene", value: (r) => r.name }, { name: "method", value: (r) => r.method }, { name: "setting", value: (r) => r.setting }, { name: "machine", value: (r) => r.machine }, { name: "frame", value: (r) => r.x },
      ...FRAME_COSTS.map(([key, what]) => ({ name: key === "energy" ? titled(what, units) : what, value: (r) => r.frame[key] })),
    ];
    body.replaceChildren(h("div", { class: "controls" }, choice("Of each frame", FRAME_COSTS.map(([key, what]) => [key, what]), cost, (value) => ((cost = value), draw()))), keys(methods), h("div", { class: "grid" }, charts), dataTable("Frame by frame", columns, rows));
  };
  section.append(h("p", {}, "The first frame finds the caches empty; every other finds them as the one before left them."), body);
  draw();
}
