// Results of every kind as points: a method with a setting, of a view, with its errors and costs.

const ENERGY_PARTS = ["l1", "l2", "dram", "compute", "leakage"];

function errorTimePoints(doc) {
  const machine = (k) => [doc.machines[k].label, ...doc.machines[k].set].join(" ");
  return doc.points.map((p) => {
    const view = doc.views[p.view];
    const scene = doc.scenes[view.scene];
    const shift = view.shift.find((s) => s.samples === p.samples)?.picture ?? null;
    const costs = p.costs.map((c) => ({ ...c, target: target(machine(c.machine), c.compute) }));
    const { geometry, picture, viewed } = p;
    return { scene: scene.name, distance: view.distance, eye: view.eye, size: view.size, view: p.view, method: p.method, setting: p.setting, knobs: p.knobs, choices: p.choices, samples: p.samples, bytes: p.bytes, bytes_per_triangle: p.bytes_per_triangle, errors: { geometry, picture, viewed }, shift, costs, converged: view.converged };
  });
}

const target = (machine, compute) => `${machine}, compute ${compute}`;

/** Results of simulations; those of one view and setting on several machines are one point. */
function simulationPoints(simulations) {
  const points = new Map();
  for (const { scene, result, image } of simulations) {
    const { setup } = result;
    const { view, method } = setup;
    const eye = view?.eye ?? [0, 0, 0];
    const distance = view ? view.distance ?? Math.hypot(...eye) : null;
    const setting = settingOf(method);
    const name = scene ?? setup.scene.name;
    const key = JSON.stringify([name, eye, view?.size, setup.rays, method.name, setting]);
    if (!points.has(key)) {
      const picture = image && { rmse: image.rmse, psnr_db: image.psnr_db };
      const geometry = image && { surfaces_mean: image.geometry_pixels_mean };
      points.set(key, { scene: name, distance, byRadii: view?.distance != null, eye, size: view?.size, rays: setup.rays, method: method.name, setting, knobs: method.knobs ?? {}, choices: method.choices ?? {}, samples: 1, bytes: method.bytes, bytes_per_triangle: method.bytes / setup.scene.finest_triangles, errors: { picture, geometry }, shift: null, costs: [] });
    }
    const e = result.energy;
    const energy = { unit: e.unit, total: e.total, ...Object.fromEntries(ENERGY_PARTS.map((part) => [part, e[part].total])) };
    const machine = [setup.machine.label, ...setup.machine.set].join(" ");
    points.get(key).costs.push({ keys: machineKeys(setup.machine.description), target: target(machine, setup.compute), compute: setup.compute, cycles: result.cycles, milliseconds: result.milliseconds, energy, dram_lines: result.dram.reads + result.dram.writes, dram_bytes: result.dram.bytes, l1_requests_per_ray: result.accesses_per_ray, traffic: result.traffic, intervals: result.intervals ?? [], roofline: result.roofline, stalls: result.stalls, latencies: result.latencies, units: result.units });
  }
  return [...points.values()];
}

function settingOf(method) {
  const words = [];
  if (method.delta != null) words.push(`delta ${method.delta}`);
  // What it chose by itself is another from view to view, and no setting.
  for (const [name, value] of Object.entries(method.knobs ?? {})) if (name !== "delta" && !name.startsWith("leaf")) words.push(`${name} ${value}`);
  if (method.leaves) words.push(`leaves ${method.leaves}`);
  return words.join(", ") || "full resolution";
}

/** The errors: where they are in a point, and how they are drawn. */
function errorMeasures() {
  const spread = (group, path, what, unit) => [["percentile_99", "99th percentile"], ["mean", "mean"], ["median", "median"], ["maximum", "maximum"]].map(([key, word]) => ({ id: `${path}.${key}`, path: `${path}.${key}`.split("."), group, name: `${what}, ${word}`, unit }));
  const picture = (path, group) => {
    const of = (key, name, more = {}) => ({ id: `${path}.${key}`, path: [path, key], group, name, isPicture: path === "picture", ...more });
    return [
      of("rmse", "RMSE", { unit: "of 255" }),
      of("psnr_db", "PSNR", { unit: "dB", linear: true, larger: true }),
      { ...of("ssim", "1 − SSIM"), from: (v) => 1 - v },
      ...spread(group, `${path}.flip`, "FLIP").map((m) => ({ ...m, isPicture: path === "picture" })),
      of("off", "pixels off", { unit: "share" }),
    ];
  };
  return [
    ...spread("Surface", "geometry.surface", "to the nearest point of the surface", "pixels"),
    ...spread("Surface", "geometry.hit", "to the full-resolution hit", "pixels"),
    ...spread("Surface", "geometry.normal_degrees", "angle between normals", "degrees"),
    { id: "geometry.surfaces_mean", path: ["geometry", "surfaces_mean"], group: "Surface", name: "distance between the surfaces, mean", unit: "pixels" },
    { id: "geometry.silhouette.share", path: ["geometry", "silhouette", "share"], group: "Surface", name: "pixels that one of the two hits", unit: "share" },
    ...picture("picture", "Picture, against full resolution with as many samples"),
    ...picture("viewed", "Picture, against the converged one"),
  ];
}

/** The costs: `of` a point and one of its machines. */
const COSTS = [
  { id: "milliseconds", name: "time", unit: "ms", of: (p, c) => c?.milliseconds },
  { id: "cycles", name: "cycles", unit: "", of: (p, c) => c?.cycles },
  { id: "energy.total", name: "energy", energy: true, of: (p, c) => c?.energy.total },
  ...ENERGY_PARTS.map((part) => ({ id: `energy.${part}`, name: `energy, ${{ l1: "L1", l2: "L2", dram: "DRAM" }[part] ?? part}`, energy: true, of: (p, c) => c?.energy[part] })),
  { id: "dram_lines", name: "DRAM lines", unit: "", of: (p, c) => c?.dram_lines },
  { id: "dram_bytes", name: "DRAM bytes", unit: "", of: (p, c) => c?.dram_bytes },
  { id: "l1_requests_per_ray", name: "L1 requests for each ray", unit: "", of: (p, c) => c?.l1_requests_per_ray },
  { id: "unit_gates", name: "area of a traversal unit", unit: "gate equivalents", of: (p, c) => c?.unit_gates },
  { id: "bytes", name: "memory of the method", unit: "bytes", of: (p) => p.bytes },
  { id: "bytes_per_triangle", name: "memory for each finest triangle", unit: "bytes", of: (p) => p.bytes_per_triangle },
];

function errorOf(point, measure) {
  let value = point.errors;
  for (const key of measure.path) value = value?.[key];
  return value == null ? null : measure.from ? measure.from(value) : value;
}

function shiftOf(point, measure) {
  if (!measure.isPicture || !point.shift) return null;
  let value = point.shift;
  for (const key of measure.path.slice(1)) value = value?.[key];
  return value == null ? null : measure.from ? measure.from(value) : value;
}

const costAt = (point, machine) => point.costs.find((c) => c.target === machine);
const costUnit = (cost, points, machine) => (cost.energy ? points.map((p) => costAt(p, machine)?.energy.unit).find(Boolean) ?? "" : cost.unit);
const titled = (name, unit) => (unit ? `${name} (${unit})` : name);

/** Errors below this are rounding beside the largest of `values`: nothing on a logarithmic axis. */
const rounding = (values) => 1e-5 * (d3.max(values) ?? 0);

/** The points that no other beats: not dearer and not worse, and one of both better. */
function front(rows) {
  const sorted = [...rows].sort((a, b) => a.x - b.x || a.rank - b.rank);
  let best = Infinity;
  return sorted.filter((row) => row.rank < best && ((best = row.rank), true));
}
