"use strict";
// Shows what the server sends: the picture once, and then what has changed in it. Texts of the system become text nodes;
// only the picture, which the server has drawn and escaped, becomes elements.
const token = new URLSearchParams(location.search).get("token");
const at = (id) => document.getElementById(id);
const history = new Map(); // the rates of each row, one for each half second
const HISTORY = 120, TICK = 500, POINTS = 3000;
let known = {}, parts = {}, drawn = "", selected = null, source = null, field = "", points = [], zoom = null;

function connect() {
  if (source) source.close();
  const query = new URLSearchParams({ token, view: at("view").value });
  if (selected && selected.gate) {
    query.set("gate", selected.gate);
    if (field) query.set("field", field);
  }
  source = new EventSource("/events?" + query);
  source.addEventListener("state", (event) => show(JSON.parse(event.data)));
  source.addEventListener("gate", (event) => showGate(JSON.parse(event.data)));
  source.addEventListener("open", () => { known = {}; showProblems(); });
  source.addEventListener("error", () => {
    at("problems").className = "away";
    at("problems").textContent = "no connection to scl watch";
  });
}

function show(values) {
  if (values.picture !== undefined) {
    drawPicture(values.picture);
    values = Object.assign({}, known, values);
  }
  for (const [name, value] of Object.entries(values)) {
    known[name] = value;
    const [kind, ...rest] = name.split(" ");
    const part = parts[name];
    if (value === null) continue;
    if (kind === "block" && part) showBlock(part, value);
    if (kind === "row" && part) showRow(part, value);
    if (kind === "edge" && part) showEdge(part, value);
    if (kind === "problems") showProblems();
    if (kind === "events") showEvents(value);
    if (kind === "component" && selected && selected.component === rest.join(" ")) showComponent(value);
  }
}

function drawPicture(text) {
  if (text === drawn) return;
  drawn = text;
  const holder = at("picture");
  holder.innerHTML = text;
  const picture = holder.querySelector("svg");
  at("system").textContent = picture.querySelector("title").textContent;
  document.title = at("system").textContent + " – SCL";
  parts = {};
  for (const part of holder.querySelectorAll("[data-part]")) {
    parts[part.dataset.part] = part;
    if (part.dataset.gate || part.dataset.component) {
      part.classList.toggle("selected", isSelected(part));
      part.addEventListener("click", (event) => { event.stopPropagation(); select(part); });
      part.addEventListener("keydown", (event) => {
        if (event.key === "Enter") { event.stopPropagation(); select(part); }
      });
    }
  }
  resize();
  search();
}

function resize() {
  const picture = at("picture").querySelector("svg");
  if (!picture) return;
  const [, , width, height] = picture.getAttribute("viewBox").split(" ").map(Number);
  // As wide as the window at first, but readable.
  if (zoom === null) zoom = Math.min(1, Math.max(0.6, at("picture").clientWidth / width));
  picture.setAttribute("width", width * zoom);
  picture.setAttribute("height", height * zoom);
}

function setClass(part, prefix, word) {
  for (const name of [...part.classList]) if (name.startsWith(prefix)) part.classList.remove(name);
  part.classList.add(prefix + word);
}

function showBlock(part, value) {
  setClass(part, "state-", value.state);
  const badge = part.querySelector(".badge");
  badge.textContent = value.state === "running" || value.state === "stopped" ? "" : value.state;
}

function showRow(part, value) {
  part.classList.toggle("bad", value.bad);
  part.querySelector(".rate").textContent = value.rate;
  part.querySelector(".trouble").textContent = value.trouble;
  const filled = part.querySelector(".filled");
  filled.setAttribute("width", value.filled * Number(filled.dataset.most));
}

function showEdge(part, value) {
  setClass(part, "flow-", value.flow);
  part.style.setProperty("--width", value.width);
}

function showProblems() {
  const problems = known.problems || [];
  at("problems").className = problems.length ? "bad" : "";
  const more = problems.length > 3 ? `, and ${problems.length - 3} more` : "";
  at("problems").textContent = problems.length ? problems.slice(0, 3).join("; ") + more : "nothing is wrong";
  at("problems").title = problems.join("\n");
}

function element(name, text, attributes = {}) {
  const made = document.createElement(name);
  made.textContent = text;
  return Object.assign(made, attributes);
}

function showEvents(events) {
  const shown = events.slice(-30).map((event) => {
    const item = element("li", "", { className: event.kind });
    item.append(element("time", new Date(event.time).toLocaleTimeString()), ` ${event.who} ${event.what}`);
    return item;
  });
  at("events").replaceChildren(...shown);
}

// The rates of the last minute, as small curves.
setInterval(() => {
  for (const [name, value] of Object.entries(known)) {
    if (!name.startsWith("row ") || value === null) continue;
    const rates = history.get(name) || [];
    rates.push(value.perSecond);
    if (rates.length > HISTORY) rates.shift();
    history.set(name, rates);
    const spark = parts[name] && parts[name].querySelector(".spark");
    if (!spark) continue;
    const { x, y, width, height } = JSON.parse(spark.dataset.area);
    const top = Math.max(...rates, 1e-9);
    const first = HISTORY - rates.length; // the newest is at the right end
    const point = (rate, index) => `${x + ((first + index) / (HISTORY - 1)) * width} ${y + height * (1 - rate / top)}`;
    spark.setAttribute("d", rates.some((rate) => rate > 0) ? "M" + rates.map(point).join("L") : "");
  }
}, TICK);

function isSelected(part) {
  const { gate, component } = part.dataset;
  if (selected === null) return false;
  return gate !== undefined ? gate === selected.gate : component !== undefined && component === selected.component;
}

function markSelected() {
  for (const part of Object.values(parts)) part.classList.toggle("selected", isSelected(part));
}

function select(part) {
  selected = { gate: part.dataset.gate, component: part.dataset.component };
  markSelected();
  field = "";
  points = [];
  at("details").hidden = false;
  at("subject").textContent = selected.gate || selected.component;
  for (const id of ["facts", "message", "calls", "field"]) at(id).replaceChildren();
  at("plot").hidden = at("calls").hidden = true;
  if (selected.component) {
    showComponent(known["component " + selected.component] || { activity: "stopped", parameters: [] });
  } else {
    at("message").textContent = "waiting for a message";
  }
  connect();
}

function deselect() {
  at("details").hidden = true;
  const had = selected && selected.gate;
  selected = null;
  markSelected();
  if (had) connect();
}

function facts(entries) {
  const shown = entries.filter(([, value]) => value !== null && value !== undefined);
  at("facts").replaceChildren(...shown.flatMap(([name, value]) => [element("dt", name), element("dd", value)]));
}

function showComponent(value) {
  facts([
    ["state", value.activity],
    ["process", value.pid],
    ["running for", value.since === null || value.since === undefined ? null : value.since + " s"],
    ["processor", typeof value.processor === "number" ? (value.processor * 100).toFixed(1) + " %" : null],
    ["memory", typeof value.memory === "number" ? (value.memory / 1048576).toFixed(1) + " MiB" : null],
    ...value.parameters.map(([name, text]) => [name, text]),
  ]);
}

function showGate(value) {
  if (!selected || value.gate !== selected.gate) return;
  if (value.error) {
    at("message").textContent = value.error;
    return;
  }
  facts([
    ["sent", new Date(value.time).toLocaleTimeString()],
    ["number", value.sequence],
    ["size", value.bytes + " B"],
  ]);
  at("message").textContent = value.text;
  showFields(value.fields);
  points.push(...value.points);
  points.splice(0, Math.max(0, points.length - POINTS));
  plot();
  const rows = value.calls.slice().reverse().map((call) => {
    const row = document.createElement("tr");
    row.append(element("td", call.kind), element("td", call.call), element("td", call.text));
    return row;
  });
  at("calls").hidden = rows.length === 0;
  at("calls").replaceChildren(...rows);
}

function showFields(fields) {
  const choice = at("field");
  at("plot").hidden = fields.length === 0;
  const shown = [...choice.options].map((option) => option.value).slice(1);
  if (fields.join("\n") === shown.join("\n")) return;
  choice.replaceChildren(element("option", "–", { value: "" }), ...fields.map((it) => element("option", it, { value: it })));
  choice.value = fields.includes(field) ? field : "";
}

function plot() {
  const path = at("plot").querySelector("path");
  if (points.length < 2) {
    path.setAttribute("d", "");
    at("range").textContent = field ? "waiting for numbers" : "choose a field";
    return;
  }
  const values = points.map(([, value]) => value).filter(Number.isFinite);
  const [start, end] = [points[0][0], points[points.length - 1][0]];
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const x = (time) => ((time - start) / Math.max(end - start, 1)) * 300;
  const y = (value) => 115 - ((value - low) / (high - low || 1)) * 110;
  const drawn = points.filter(([, value]) => Number.isFinite(value)).map(([time, value]) => `${x(time)} ${y(value)}`);
  path.setAttribute("d", "M" + drawn.join("L"));
  at("range").textContent = `${low.toPrecision(5)} to ${high.toPrecision(5)}, ${((end - start) / 1e3).toFixed(1)} s`;
}

function search() {
  const wanted = at("search").value.trim().toLowerCase();
  for (const block of at("picture").querySelectorAll(".block")) {
    const texts = [block.dataset.component, ...[...block.querySelectorAll("[data-gate]")].map((it) => it.dataset.gate)];
    block.classList.toggle("dim", wanted !== "" && !texts.some((text) => text.toLowerCase().includes(wanted)));
  }
}

at("search").addEventListener("input", search);
at("view").addEventListener("change", () => { deselect(); history.clear(); connect(); });
at("close").addEventListener("click", deselect);
at("field").addEventListener("change", () => { field = at("field").value; points = []; connect(); });
at("larger").addEventListener("click", () => { zoom = Math.min(zoom * 1.25, 4); resize(); });
at("smaller").addEventListener("click", () => { zoom = Math.max(zoom / 1.25, 0.1); resize(); });
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") { at("search").value = ""; search(); deselect(); }
  if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement) return;
  if (event.key === "/") { event.preventDefault(); at("search").focus(); }
  if (event.key === "+") at("larger").click();
  if (event.key === "-") at("smaller").click();
});
connect();
