// The page: what there is becomes sections.

let page;

/** What is chosen for all sections, and who is told of changes. */
class State {
  constructor(points) {
    this.all = points;
    this.settings = {};
    this.listeners = [];
    this.scenes = unique(points.map((p) => p.scene));
    this.scene = this.scenes[0];
    this.samples = "all";
    this.fit();
  }
  /** Keeps what is chosen among what there is. */
  fit() {
    const here = this.all.filter((p) => p.scene === this.scene);
    this.machines = unique(here.flatMap((p) => p.costs.map((c) => c.target)));
    if (!this.machines.includes(this.machine)) this.machine = this.machines[0];
    this.sampleCounts = unique(here.map((p) => p.samples)).sort((a, b) => a - b);
    if (!this.sampleCounts.includes(Number(this.samples))) this.samples = this.sampleCounts.length > 1 ? String(this.sampleCounts[0]) : "all";
  }
  points() {
    return this.all.filter((p) => p.scene === this.scene && costAt(p, this.machine) && (this.samples === "all" || p.samples === Number(this.samples))).sort(by((p) => p.distance ?? 0));
  }
  onChange(listener) {
    this.listeners.push(listener);
    listener();
  }
  changed() {
    this.fit();
    this.listeners.forEach((listener) => listener());
  }
}

function globalControls(state) {
  const bar = h("div", { class: "controls global" });
  const draw = () => {
    const set = (key) => (value) => ((state[key] = value), state.changed());
    bar.replaceChildren(
      choice("Scene", state.scenes.map((s) => [s, s]), state.scene, set("scene")),
      choice("Machine", state.machines.map((m) => [m, m]), state.machine, set("machine")),
      state.sampleCounts.length > 1 ? choice("Samples per pixel", [...state.sampleCounts.map((n) => [String(n), num(n)]), ["all", "all"]], state.samples, set("samples")) : "",
    );
  };
  state.onChange(draw);
  return bar;
}

/** The sizes of the frames stand in the headlines of what is of them. */
function headlines(state, made) {
  state.onChange(() => {
    const size = sizeWords(state.all.filter((p) => p.scene === state.scene).map((p) => p.size));
    made.forEach(([section, , ofFrames]) => ofFrames && section.querySelector("h2 .size").replaceChildren(size ? `, ${size}` : ""));
  });
}

/** Light, dark, or as the system says. */
function theme() {
  const root = document.documentElement;
  const button = document.getElementById("theme");
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const modes = ["auto", "light", "dark"];
  let mode = "auto";
  try {
    mode = modes.includes(localStorage.getItem("lodray-theme")) ? localStorage.getItem("lodray-theme") : "auto";
  } catch {} // a page from a file may have no storage
  const apply = () => {
    root.dataset.theme = mode === "auto" ? (dark.matches ? "dark" : "light") : mode;
    button.querySelector("span").textContent = { auto: "Auto", light: "Light", dark: "Dark" }[mode];
    button.setAttribute("aria-label", { auto: "Auto: colours as the system says", light: "Light colours", dark: "Dark colours" }[mode]);
  };
  button.addEventListener("click", () => {
    mode = modes[(modes.indexOf(mode) + 1) % 3];
    try {
      localStorage.setItem("lodray-theme", mode);
    } catch {}
    apply();
  });
  dark.addEventListener("change", apply);
  apply();
}

/** Colours of the palette as custom properties, for both grounds. */
function colours() {
  const rgb = (c) => `rgb(${c.join(",")})`;
  const rules = (ground) => [
    ...Object.entries(page.palette.methods).map(([name, style]) => `--method-${CSS.escape(name)}:${rgb(style[ground])};`),
    ...page.palette.parts.map((p) => `--part-${p.name}:${rgb(p[ground])};`),
    ...page.palette.sections.map((s) => `--section-${s.name}:${rgb(s[ground])};`),
  ].join("");
  document.head.append(h("style", {}, `:root{${rules("light")}}:root[data-theme="dark"]{${rules("dark")}}@media print{:root[data-theme="dark"]{${rules("light")}}}`));
  document.body.append(hatchings());
}

async function start() {
  theme();
  page = await block("data");
  colours();
  const main = document.getElementById("main");
  const contents = h("ul", {});
  const state = new State([...(page.error_time ? errorTimePoints(page.error_time) : []), ...simulationPoints(page.simulations)]);
  const hasPoints = state.all.length > 0;
  const several = unique(state.all.map((p) => p.distance)).length > 1;
  const sections = [
    ["verdict", "Verdict", verdictSection, page.verdicts.length > 0],
    ["work", "Error against cost", workSection, hasPoints && errorMeasures().some((m) => state.all.some((p) => errorOf(p, m) != null))],
    ["distance", "By distance", distanceSection, hasPoints && several],
    ["size", "By size of the frame", sizeSection, unique((page.error_time?.sizes ?? []).map((s) => String(s.size))).length > 1],
    ["parts", "Time, energy and traffic", partsSection, hasPoints],
    ["machine", "By the machine", machineSection, variedKeys(state.all).length > 0],
    ["frames", "Frame by frame", framesSection, ofSeveralFrames().length > 0],
    ["pictures", "Pictures and rays", picturesSection, page.pictures.length > 0],
    ["equal", "At equal error", equalSection, page.error_time?.equal_error.length > 0],
    ["left-out", "With less in scene and unit", leftOutSection, page.error_time?.left_out?.length > 0],
    ["stability", "Stability", stabilitySection, page.stability.length > 0],
    ["claims", "The paper’s claims", ledgerSection, page.ledger.length > 0],
    ["run", "How it was run", runSection, true],
  ].filter(([, , , is]) => is);
  // Pictures are asked for from the diagrams before their own section is there.
  if (!page.pictures.length) state.showPicture = null;
  else state.showPicture = () => {};
  const withoutFrames = ["stability", "claims", "run"];
  const made = sections.map(([id, title, fill]) => [h("section", { id, "aria-labelledby": `${id}-title` }, h("h2", { id: `${id}-title` }, title, h("span", { class: "size" }))), fill, !withoutFrames.includes(id)]);
  contents.append(...sections.map(([id, title]) => h("li", {}, h("a", { href: `#${id}` }, title))));
  document.getElementById("contents").replaceChildren(contents);
  // The verdict heads the page; what is chosen below is of the rest.
  const head = made.filter(([section]) => section.id === "verdict").map(([section]) => section);
  main.replaceChildren(...head, ...(page.error_time ? [sizesNote()] : []), ...(hasPoints ? [glance(state), globalControls(state)] : []), ...made.map(([section]) => section).filter((section) => !head.includes(section)));
  made.forEach(([section, fill]) => fill(section, state));
  headlines(state, made);
  document.documentElement.dataset.ready = String(Math.round(performance.now()));
}

start().catch((error) => {
  document.getElementById("main").replaceChildren(h("p", { role: "alert" }, `This page could not be drawn: ${error.message}. It needs a browser of 2023 or later.`));
  throw error;
});
