// Drives a page in Chromium: node drive.mjs MODULES CHROMIUM PAGE DOCUMENT [SHOTS]. Prints what was found as JSON: `faults` are sentences.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [modules, chromiumPath, file, documentFile, shots] = process.argv.slice(2);
const require = createRequire(`${modules}/node_modules/`);
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
const text = documentFile && documentFile !== "-" ? readFileSync(documentFile, "utf8") : "";
const isSweep = text && documentFile.endsWith(".jsonl");
const isResult = text && documentFile.endsWith("result.json");
const doc = text && !isSweep && !isResult ? JSON.parse(text) : null;
const runs = isSweep ? text.trim().split("\n").map((line) => JSON.parse(line).result) : [];

const faults = [];
const counts = { points: 0, diagrams: 0, cells: 0, axe_rules: 0, steps: 0 };
const check = (is, words) => is || faults.push(words);
const same = (a, b) => a.length === b.length && a.every((row, k) => row.every((v, j) => v === b[k][j]));
const sorted = (rows) => [...rows].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
const get = (object, path) => path.split(".").reduce((o, key) => o?.[key], object);

const browser = await chromium.launch({ executablePath: chromiumPath, args: ["--no-sandbox", "--disable-dev-shm-usage"] });
const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, colorScheme: "light" });
const page = await context.newPage();
page.setDefaultTimeout(20000);
page.on("console", (m) => ["error", "warning"].includes(m.type()) && faults.push(`console: ${m.text()}`));
page.on("pageerror", (e) => faults.push(`error: ${e.message}`));
const address = pathToFileURL(file).href;
page.on("request", (r) => check(r.url() === address || /^(blob|data):/.test(r.url()), `asked for ${r.url()}`));
await page.goto(address);
await page.waitForSelector("html[data-ready]");
const ready = Number(await page.evaluate(() => document.documentElement.dataset.ready));

/** Frames, not time alone: a busy machine may draw none for a while. */
const rendered = async (ms = 150) => {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.waitForTimeout(ms);
};
/** What the diagrams of a section show. */
const dots = (id) => page.evaluate((id) => [...document.querySelectorAll(`#${id} [data-point]`)].map((e) => [Number(e.dataset.x), Number(e.dataset.y)]), id);

if (doc) {
  const scene = doc.scenes[0].name;
  const machine = `${doc.machines[0].label}, compute free`;
  // By default the fewest samples.
  const fewest = Math.min(...doc.points.map((p) => p.samples));
  const of = doc.points.filter((p) => doc.scenes[doc.views[p.view].scene].name === scene && p.samples === fewest);
  const costOf = (p, id) => (id === "bytes" || id === "bytes_per_triangle" ? p[id] : get(p.costs.find((c) => c.machine === 0 && c.compute === "free"), id));
  const errorOf = (p, id) => {
    const [where, ...rest] = id.split(".");
    const value = get(p[where], rest.join("."));
    return value == null ? null : rest[0] === "ssim" ? 1 - value : value;
  };
  const work = page.locator("#work");
  const errors = await work.getByLabel("Error", { exact: true }).locator("option").evaluateAll((all) => all.map((o) => o.value));
  const costs = await work.getByLabel("Cost", { exact: true }).locator("option").evaluateAll((all) => all.map((o) => o.value));
  check(errors.length >= 12 && costs.length >= 8, `${errors.length} errors and ${costs.length} costs to choose`);
  check((await page.getByLabel("Machine", { exact: true }).inputValue()) === machine, "the machine is not the first");
  for (const [k, error] of errors.entries()) {
    // Every error and every cost at least once, and all pairs with the first.
    for (const cost of k === 0 ? costs : [costs[k % costs.length]]) {
      await work.getByLabel("Error", { exact: true }).selectOption(error);
      await work.getByLabel("Cost", { exact: true }).selectOption(cost);
      await rendered(60);
      const wanted = sorted(of.flatMap((p) => (errorOf(p, error) == null || !(costOf(p, cost) > 0) ? [] : [[costOf(p, cost), errorOf(p, error)]])));
      const shown = sorted(await dots("work"));
      check(wanted.length > 0 && same(wanted, shown), `${error} against ${cost}: ${shown.length} marks, ${wanted.length} points in the document, or other figures`);
      counts.points += shown.length;
      counts.diagrams += 1;
    }
  }
  // A choice keeps the focus when its section is drawn again.
  await work.getByLabel("Cost", { exact: true }).focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowDown");
  check(await page.evaluate(() => document.activeElement.matches("#work select")), "a choice loses the focus");
  // The line of a shift by half a pixel is in picture errors only.
  const dashes = async (error) => {
    await work.getByLabel("Error", { exact: true }).selectOption(error);
    await rendered(60);
    return page.locator("#work svg [stroke-dasharray='7 4']").count();
  };
  check((await dashes("picture.rmse")) > 0, "no line of the shift by half a pixel");
  check((await dashes("geometry.surface.mean")) === 0, "the shift by half a pixel stands where it is no error");
  await work.getByLabel("Cost", { exact: true }).selectOption("milliseconds");
  await work.getByLabel("Error", { exact: true }).selectOption("picture.rmse");
  await rendered();

  // The table beside the plot.
  await work.locator("summary").first().click();
  // Its rows are made at the toggle event, which comes after the click.
  await work.locator("td[data-value]").first().waitFor();
  const cells = await work.locator("td[data-value]").evaluateAll((all) => all.map((e) => [Number(e.dataset.value), e.textContent]));
  const values = new Set(cells.map(([v]) => v));
  check(of.every((p) => values.has(p.picture.rmse) && values.has(costOf(p, "milliseconds"))), "the table lacks a figure of the document");
  check(cells.every(([value, text]) => Math.abs(Number(text.replace(/[\u202f]/g, "")) - value) <= Math.abs(value) * 1e-3 + 1e-9), "a cell says another figure than its value");
  counts.cells += cells.length;
  const [download] = await Promise.all([page.waitForEvent("download"), work.getByRole("button", { name: /^CSV/ }).click()]);
  const csv = readFileSync(await download.path(), "utf8").trim().split("\n");
  check(csv.length === of.length + 1 && csv.slice(1).every((line, k) => line.split(",").length >= 7 && k >= 0), `the CSV has ${csv.length} lines for ${of.length} points`);
  await work.locator("summary").first().click();

  // By distance: gains are those of the document.
  const gains = await page.evaluate(() => [...document.querySelectorAll("#distance [data-point]")].map((e) => [e.getAttribute("aria-label"), Number(e.dataset.x), Number(e.dataset.y)]));
  check(gains.length > 0, "no marks by distance");
  for (const [label, distance, y] of gains.filter(([label]) => /gain over bvh/.test(label))) {
    const base = of.find((p) => p.method === "bvh" && doc.views[p.view].distance === distance);
    const gain = Number(/gain over bvh ([\d.\u202f]+)/.exec(label)[1].replace(/\u202f/g, ""));
    check(Math.abs(costOf(base, "milliseconds") / y - gain) <= Math.max(0.051 * (gain < 9.95 ? 1 : 0), gain < 0.995 ? 0.0051 : 0, gain >= 9.95 ? 0.51 : 0), `gain ${gain} at ${distance}`);
  }
  // Energy by part.
  const parts = await page.evaluate(() => [...document.querySelectorAll("#parts svg[aria-label^='Energy by part'] [data-point]")].length);
  check(parts % 5 === 0 && parts > 0, `${parts} parts of energies`);

  // The verdict: every view once, with the cheapest method that is near enough, from the document's own figures.
  const fewestOf = Math.min(...doc.equal_error.map((e) => e.samples));
  const near = doc.equal_error.filter((e) => e.error === "surface-p99" && e.level === 0.5 && e.samples === fewestOf && ["time", "energy", "dram-lines"].includes(e.cost));
  const winnerOf = (e) => {
    const rival = e.methods.filter((m) => m.cost != null).sort((a, b) => a.cost - b.cost)[0];
    const over = rival && e.ours != null ? rival.cost / e.ours : null;
    const best = over == null ? (e.ours != null ? "lod" : rival?.method ?? null) : Math.abs(over - 1) < 0.005 ? null : over < 1 ? rival.method : "lod";
    return `${e.view} ${e.cost} ${best} ${over == null ? null : over.toPrecision(9)}`;
  };
  const map = await page.locator("#verdict td[data-view]").evaluateAll((all) => all.map((e) => `${e.dataset.view} ${e.dataset.cost} ${e.dataset.best ?? null} ${e.dataset.value == null ? null : Number(e.dataset.value).toPrecision(9)}`));
  check(near.length > 0 && map.length === near.length && JSON.stringify([...map].sort()) === JSON.stringify(near.map(winnerOf).sort()), `the map of winners is ${map}, the document has ${near.map(winnerOf)}`);
  check((await page.evaluate(() => document.querySelector("main").firstElementChild.id)) === "verdict", "the verdict does not head the page");
  counts.winners = map.length;
  // Cards: every rival with its range.
  for (const cost of ["time", "energy", "dram-lines"]) {
    for (const method of doc.methods.map((m) => m.name).filter((name) => name !== "lod")) {
      const of = near.filter((e) => e.cost === cost && e.compute === "free" && doc.views[e.view].scene === 0).flatMap((e) => e.methods.filter((m) => m.method === method && m.ratio != null).map((m) => m.ratio));
      const line = of.length ? await page.locator(`.glance [data-cost="${cost}"] [data-method="${method}"]`).textContent() : "";
      check(!of.length || line.endsWith(`above 1 in ${of.filter((r) => r > 1).length} of ${of.length} view${of.length === 1 ? "" : "s"}`), `the card of ${cost} says '${line}' of ${method}, the document ${of}`);
    }
  }
  // Sizes in the headlines; both sizes are told.
  const frameSize = doc.views[0].size.join(" × ");
  const headlines = await page.evaluate(() => [...document.querySelectorAll("main h2")].filter((e) => !["stability", "claims", "run"].includes(e.parentElement.id)).map((e) => e.textContent));
  check(headlines.length > 4 && headlines.every((words) => words.endsWith(`, ${frameSize}`)), `a headline lacks the size: ${headlines}`);
  check((await page.title()).includes(doc.views[0].size.join("x")), "the title lacks the size");
  const both = await page.locator("#sizes").textContent();
  check([frameSize, doc.views[0].size.map((n) => Math.floor(n / doc.views[0].every)).join(" × ")].every((words) => both.includes(words)), `the sizes are not told: ${both}`);
  // By size of the frame.
  const costBySize = [(c) => c.milliseconds, (c) => c.energy.total, (c) => c.dram_lines];
  const free = (s) => s.costs.find((c) => c.machine === 0 && c.compute === "free");
  // Of the first scene's nearest view that has them.
  const [{ view: nearest }] = doc.sizes.filter((s) => doc.views[s.view].scene === 0).sort((a, b) => doc.views[a.view].distance - doc.views[b.view].distance);
  const ofView = doc.sizes.filter((s) => s.view === nearest);
  const bySize = ofView.filter((s) => s.method !== "lod").flatMap((s) => costBySize.map((of) => [s.size[0], of(free(s)) / of(free(ofView.find((o) => o.method === "lod" && String(o.size) === String(s.size))))]));
  check(bySize.length > 0 && same(sorted(bySize), sorted(await dots("size"))), "the diagram over size is not the document's");

  // At equal error.
  const ratios = await page.locator("#equal td[data-value]").evaluateAll((all) => all.map((e) => Number(e.dataset.value)));
  const level = 0.5;
  await page.locator("#equal").getByLabel("Level", { exact: true }).selectOption(String(level));
  await rendered();
  const shownNow = await page.locator("#equal td[data-value]").evaluateAll((all) => all.map((e) => Number(e.dataset.value)));
  check(ratios.length > 0 && shownNow.length > 0, "no equal errors");
  const equal = doc.equal_error.filter((e) => doc.views[e.view].scene === 0 && e.samples === fewest && e.level === level && ["error", "cost", "compute"].every((key) => e[key] === doc.equal_error[0][key]));
  check(equal.length > 0 && equal.every((e) => [e.ours, ...[...e.methods, ...e.own_rule].flatMap((m) => [m.cost, m.ratio])].every((value) => value == null || shownNow.includes(value))), "equal errors are not the document's");
  const rivals = [...doc.methods.filter((m) => m.name !== "lod").map((m) => m.name), ...doc.methods.filter((m) => m.in_steps).map((m) => `${m.name}, own rule`)];
  const fits = (where) => page.evaluate((where) => [...document.querySelectorAll("#equal .scroll, #verdict .scroll")].every((e) => e.scrollWidth <= e.clientWidth) || where, where);
  const heads = await page.locator("#equal thead th").allTextContents();
  check(rivals.every((name) => heads.includes(name)), `at equal error ${heads}, and there are ${rivals}`);
  check((await fits("")) === true, "the tables at equal error and of winners do not fit at 1400 pixels");
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 718, height: 1000 }); // A4 with margins
  check((await fits("")) === true, "nor in print");
  await page.emulateMedia({ media: "screen" });
  await page.setViewportSize({ width: 1400, height: 900 });
  await rendered();
  const missing = equal.filter((e) => e.ours == null).length;
  check((await page.locator("#equal .why").count()) >= missing, "no reason where there is no cost");

  // What was left out.
  const lessShown = await page.locator("#left-out td[data-value]").evaluateAll((all) => all.map((e) => Number(e.dataset.value)));
  const less = doc.left_out.filter((l) => doc.views[l.point.view].scene === 0);
  const lessValues = (l) => [l.coordinate_zeros, l.direction_zeros, l.point.geometry.surface.maximum, l.point.bytes_per_triangle, l.point.costs[0].unit_gates];
  check(less.length > 0 && less.every((l) => lessValues(l).every((value) => lessShown.includes(value))), "what was left out is not the document's");

  // Pointer and keys on a diagram.
  const tip = page.locator("#work .tip:not([hidden])");
  const first = page.locator("#work [data-point][tabindex='0']").first();
  await first.scrollIntoViewIfNeeded();
  await first.hover({ force: true });
  check((await tip.count()) === 1 && /scene.*from.*samples/s.test(await tip.textContent()), "no words at a mark under the pointer");
  await page.mouse.move(2, 2);
  await first.focus();
  const before = await tip.textContent();
  await page.keyboard.press("ArrowRight");
  const after = await tip.textContent();
  check(before !== after && (await page.evaluate(() => document.activeElement.matches("[data-point][role=img][aria-label]"))), "arrows do not move to the next mark");
  await page.keyboard.press("Escape");
  check((await tip.count()) === 0, "Escape does not hide the words");

  // Slider.
  await page.locator("#pictures").scrollIntoViewIfNeeded();
  const range = page.locator("#slide");
  await range.waitFor();
  const clip = () => page.locator("#pictures .slider img").nth(1).evaluate((e) => e.style.clipPath);
  const whole = await clip();
  await range.focus();
  await page.keyboard.press("ArrowRight");
  check((await clip()) !== whole && (await range.inputValue()) === "51", "arrows do not move the slider");
  await page.keyboard.press("Home");
  check((await range.inputValue()) === "0", "Home does not move the slider");
  for (let k = 0; k < 5; k++) await page.keyboard.press("PageUp");
  check((await range.getAttribute("aria-valuetext")).includes("%"), "the slider does not say what it shows");
  // Dragging moves it too, and chooses no pixel.
  const pane = await page.locator("#pictures .slider").boundingBox();
  const column = page.locator("#pictures").getByLabel("Column", { exact: true });
  const pixel = await column.inputValue();
  await page.mouse.move(pane.x + 0.3 * pane.width, pane.y + 0.5 * pane.height);
  await page.mouse.down();
  await page.mouse.move(pane.x + 0.5 * pane.width, pane.y + 0.5 * pane.height, { steps: 4 });
  await page.mouse.move(pane.x + 0.75 * pane.width, pane.y + 0.5 * pane.height, { steps: 4 });
  await page.mouse.up();
  check(Math.abs(Number(await range.inputValue()) - 75) <= 1 && (await column.inputValue()) === pixel, "dragging does not move the slider alone");
  const sizes = await page.locator("#pictures .slider img").evaluateAll((all) => Promise.all(all.map((e) => e.decode().then(() => e.naturalWidth))));
  check(sizes.length === 2 && sizes.every((width) => width > 0), "a picture does not show");
  const left = page.locator("#pictures").getByLabel("Left picture", { exact: true });
  for (const [option, legend] of [["error", ".ramp"], ["levels", ".swatch"]]) {
    const value = (await left.locator("option").evaluateAll((all) => all.map((o) => o.value))).find((v) => v.includes(option));
    await left.selectOption(value);
    check((await page.locator(`#pictures .legend ${legend}`).count()) > 0, `no legend of ${option}`);
  }
  await left.selectOption((await left.locator("option").evaluateAll((all) => all.map((o) => o.value))).find((v) => v.startsWith("lod") && v.includes(": picture")));
  await page.locator("#pictures").getByLabel("Right picture", { exact: true }).selectOption((await left.locator("option").evaluateAll((all) => all.map((o) => o.value))).find((v) => v.startsWith("bvh,") && v.includes(": picture")));

  // Inspector: every ray of a grid says what the document says.
  const frame = page.locator("#pictures .slider");
  await page.locator(".ray").first().waitFor();
  const box = await frame.boundingBox();
  await frame.click({ position: { x: box.width * 0.5, y: box.height * 0.55 } });
  const cards = () => page.locator(".ray").evaluateAll((all) => all.map((e) => ({ method: e.dataset.method, pixel: e.dataset.pixel, steps: e.querySelectorAll("ol li").length, text: e.textContent })));
  const view = Number(await page.locator("#pictures").getByLabel("View", { exact: true }).inputValue());
  const inspect = async (where) => {
    const shown = await cards();
    check(shown.length === 2 && shown[0].method === "lod" && shown[1].method === "bvh", `${where}: rays of ${shown.map((c) => c.method)}`);
    for (const card of shown) {
      const ray = doc.traces.find((t) => t.view === view && t.method === card.method).rays.find((r) => r.pixel.join(",") === card.pixel);
      check(ray && card.steps === ray.steps.split(" ").length, `${where}: steps of ${card.method} at ${card.pixel}`);
      check(card.method !== "lod" || card.text.includes(`--text --pixel ${card.pixel}`), `${where}: no command for ${card.pixel}`);
      check(!ray?.hit || card.text.includes(`level ${ray.hit.level}`), `${where}: no hit of ${card.method}`);
      counts.steps += card.steps;
    }
    return shown[0]?.pixel;
  };
  const clicked = await inspect("click");
  await frame.focus();
  await page.keyboard.press("ArrowRight");
  check((await inspect("arrow")) !== clicked, "arrows do not move the inspected pixel");
  await page.keyboard.press("ArrowDown");
  await inspect("arrow down");
  await page.locator("#pictures").getByLabel("Column", { exact: true }).fill("0");
  await page.keyboard.press("Tab");
  await inspect("column");
}

if (isSweep) {
  // Causes of a run are the whole of its rays' time, and the table has every limit and cause of the results.
  const sums = await page.evaluate(() => [...document.querySelectorAll("#parts figure")].filter((f) => /^What held the rays/.test(f.querySelector("svg[aria-label]")?.getAttribute("aria-label") ?? "")).map((f) => [...f.querySelectorAll("[data-point]")].reduce((sum, e) => sum + Number(e.dataset.x), 0)));
  const methods = new Set(runs.map((r) => r.setup.method.name)).size;
  check(sums.length > 0 && sums.every((sum) => Math.abs(sum - 100 * methods) < 1e-6), `causes of ${methods} runs are ${sums} %`);
  // Times and cycles are those of the results.
  const bars = await page.evaluate(() => [...document.querySelectorAll("#parts svg[aria-label^='Time and cycles'] [data-point]")].map((e) => Number(e.dataset.x)));
  check(bars.length > 0 && bars.every((ms) => runs.some((r) => r.milliseconds === ms)), "times are not those of the results");
  const details = page.locator("#parts details[data-table^='Limits and causes']");
  await details.locator("summary").click();
  await details.locator("td[data-value]").first().waitFor();
  const cells = await details.locator("td[data-value]").evaluateAll((all) => all.map((e) => Number(e.dataset.value)));
  const words = await details.textContent();
  const held = (r) => r.stalls.context_cycles - (r.stalls.cycles.idle ?? 0);
  for (const r of runs) {
    const values = [...Object.values(r.roofline.limits).map((l) => 100 * l.share), ...Object.entries(r.stalls.cycles).filter(([name]) => name !== "idle").map(([, n]) => (100 * n) / held(r)), r.latencies.rays.largest];
    check(values.every((v) => cells.some((c) => Math.abs(c - v) <= 1e-9 * Math.abs(v))), `the table lacks a limit or a cause of ${r.setup.method.name}`);
    check(words.includes(r.roofline.largest) && words.includes(r.stalls.largest), `the table does not name what limits ${r.setup.method.name}`);
    counts.cells += values.length;
  }
}

if (isResult) {
  // Every frame of a run, by every cost.
  const { frames } = JSON.parse(text);
  const choice = page.locator("#frames").getByLabel("Of each frame", { exact: true });
  const costs = await choice.locator("option").evaluateAll((all) => all.map((o) => o.value));
  check(frames.length > 2 && costs.length > 4, `${frames.length} frames, ${costs.length} costs`);
  for (const cost of costs) {
    await choice.selectOption(cost);
    await rendered(60);
    const [wanted, shown] = [frames.map((frame, k) => [k + 1, frame[cost]]), sorted(await dots("frames"))];
    check(same(wanted, shown), `${cost} of the frames is ${shown}, and should be ${wanted}`);
    counts.points += shown.length;
  }
}

// Everything there is to open, both grounds, both widths.
await page.evaluate(() => document.querySelectorAll("details").forEach((d) => (d.open = true)));
for (const [width, scheme] of [[1400, "light"], [1400, "dark"], [390, "light"], [390, "dark"]]) {
  await page.setViewportSize({ width, height: width === 390 ? 844 : 900 });
  await page.emulateMedia({ colorScheme: scheme });
  await rendered(500);
  check((await page.evaluate(() => document.documentElement.dataset.theme)) === scheme, `the page is not ${scheme}`);
  const [wide, inner] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  check(wide <= inner, `at ${width} pixels the page is ${wide} wide`);
  await page.evaluate(axe);
  const result = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  counts.axe_rules += result.passes.length;
  for (const v of result.violations) faults.push(`axe, ${width} ${scheme}: ${v.id}: ${v.nodes.slice(0, 3).map((n) => `${n.target.join(" ")} ${n.any.concat(n.all, n.none).map((c) => c.message).join("; ")}`).join(" | ")} (${v.nodes.length})`);
  if (shots) {
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => (d.open = false)));
    await rendered(300);
    await page.evaluate(() => scrollTo(0, 0));
    await page.screenshot({ path: `${shots}/${width}-${scheme}.png`, fullPage: true });
    await page.evaluate(() => document.querySelectorAll("details").forEach((d) => (d.open = true)));
  }
}
// On paper: light, colours as they are, and nothing that only a screen can use.
await page.emulateMedia({ media: "print", colorScheme: "dark" });
const paper = await page.evaluate(() => ({ ground: getComputedStyle(document.body).backgroundColor, exact: getComputedStyle(document.body).printColorAdjust, seen: [...document.querySelectorAll(".controls, nav, #theme, .data button")].filter((e) => getComputedStyle(e).display !== "none").length }));
check(paper.ground === "rgb(255, 255, 255)" && paper.exact === "exact" && paper.seen === 0, `paper: ${JSON.stringify(paper)}`);
await page.emulateMedia({ media: "screen", colorScheme: "dark" });
// The button wins over the system.
await page.setViewportSize({ width: 1400, height: 900 });
const button = page.locator("#theme");
await button.focus();
await page.keyboard.press("Enter");
check((await page.evaluate(() => document.documentElement.dataset.theme)) === "light", "the button does not choose light");
await page.keyboard.press("Enter");
check((await page.evaluate(() => document.documentElement.dataset.theme)) === "dark", "the button does not choose dark");
check((await page.locator("main h2").count()) > 0, "no sections");
await browser.close();
console.log(JSON.stringify({ faults, counts, ready_ms: ready }));
