"use strict";
// Elements, numbers and files.

/** An element: properties that begin with "on" are listeners, all others attributes; children are nodes or text. */
function h(name, attributes, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes ?? {})) {
    if (value == null || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child != null && child !== false));
  return element;
}

const grouped = (digits) => digits.replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");

/** A number with `digits` significant digits at least those before the point. */
function num(value, digits = 3) {
  if (value == null || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e15 || size < 1e-4) return value.toExponential(digits - 1).replace("e+", "e");
  if (Number.isInteger(value)) return grouped(String(value));
  const before = Math.floor(Math.log10(size)) + 1;
  const text = value.toFixed(Math.max(0, digits - Math.max(before, size < 1 ? before : 0)));
  const [whole, rest] = (text.includes(".") ? text.replace(/0+$/, "").replace(/\.$/, "") : text).split(".");
  return rest ? `${grouped(whole)}.${rest}` : grouped(whole);
}

/** How many times as much. */
const times = (value) => (value == null ? "–" : `${value >= 9.95 ? num(Math.round(value)) : value >= 0.995 ? value.toFixed(1) : value.toFixed(2)}×`);

const count = (n, one, many = `${one}s`) => `${num(n)} ${n === 1 ? one : many}`;

/** A tick of a logarithmic axis. */
const tick = (v) => (v >= 1e5 || v < 1e-3 ? Number(v.toPrecision(2)).toExponential().replace("e+", "e") : num(v));

/** Bytes from base64. */
function bytes(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) out[k] = raw.charCodeAt(k);
  return out;
}

/** What block `id` of the page holds: JSON, deflated, in base64. */
async function block(id) {
  const element = document.getElementById(id);
  if (!element) return null;
  const stream = new Blob([bytes(element.textContent.trim())]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).json();
}

/** Hands a file to the reader. */
function save(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

const csvCell = (value) => {
  const text = value == null ? "" : String(value);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};
const csv = (columns, rows) => [columns.map((c) => csvCell(c.name)), ...rows.map((row) => columns.map((c) => csvCell(c.value(row))))].map((r) => r.join(",")).join("\n") + "\n";

/** A table; columns are {name, value(row), show(row)}, numbers stand on the right and keep their full value in `data-value`. */
function table(caption, columns, rows) {
  const isNumber = columns.map((c) => rows.some((row) => typeof c.value(row) === "number"));
  const cell = (c, row, k) => {
    const value = c.value(row);
    const shown = c.show ? c.show(row) : typeof value === "number" ? num(value, 4) : value ?? "–";
    return h("td", { class: isNumber[k] ? "n" : null, "data-value": typeof value === "number" ? value : null }, shown);
  };
  return h(
    "table", {},
    h("caption", { class: "visually-hidden" }, caption),
    h("thead", {}, h("tr", {}, columns.map((c, k) => h("th", { scope: "col", class: isNumber[k] ? "n" : null }, c.name)))),
    h("tbody", {}, rows.map((row) => h("tr", {}, columns.map((c, k) => cell(c, row, k))))),
  );
}

/** A table in a box that scrolls, and by keyboard too. */
const scrolled = (label, content) => h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": label }, content);

/** The data of a plot: a table behind a summary, made when it is opened, and as a file. */
function dataTable(name, columns, rows) {
  const details = h("details", { "data-table": name }, h("summary", {}, `Data (${count(rows.length, "row")})`));
  details.addEventListener("toggle", () => {
    if (details.open && details.children.length === 1) details.append(scrolled(`Data: ${name}`, table(name, columns, rows)));
  });
  const file = name.toLowerCase().replace(/[^a-z0-9.]+/g, "-").replace(/^-|-$/g, "");
  const button = h("button", { type: "button", "aria-label": `CSV of: ${name}`, onclick: () => save(`${file}.csv`, "text/csv", csv(columns, rows)) }, "CSV");
  return h("div", { class: "data" }, details, button);
}

/** A labelled choice; options are [value, text] or {group, options}. */
function choice(label, options, chosen, change) {
  const option = ([value, text]) => h("option", { value, selected: String(value) === String(chosen) }, text);
  // Sections are drawn again: the focus goes on to the new field of the same name.
  const changed = ({ target }) => {
    const place = target.closest("section, .global");
    change(target.value);
    if (!target.isConnected) [...place.querySelectorAll("select")].find((other) => other.dataset.name === label)?.focus();
  };
  const select = h("select", { "data-name": label, onchange: changed }, options.map((o) => (Array.isArray(o) ? option(o) : h("optgroup", { label: o.group }, o.options.map(option)))));
  return control(label, select);
}

let controls = 0;

/** A field with its label. */
function control(label, field) {
  field.id = `control-${(controls += 1)}`;
  return h("div", { class: "control" }, h("label", { for: field.id }, label), field);
}

const unique = (values) => [...new Set(values)];
const by = (f) => (a, b) => (f(a) < f(b) ? -1 : f(a) > f(b) ? 1 : 0);
