"use strict";
// What is shown of the component or the gate that is selected, and what can be done with it.
const token = new URLSearchParams(location.search).get("token");
const at = (id) => document.getElementById(id);
const mayAct = document.body.dataset.controls === "actions";
const LINES = 500;
let selected = null, field = "", points = [];

function isSelected(part) {
  const { gate, component } = part.dataset;
  if (selected === null) return false;
  return gate !== undefined ? gate === selected.gate : component !== undefined && component === selected.component;
}

function markSelected() {
  for (const part of Object.values(parts)) part.classList.toggle("selected", isSelected(part));
}

function select({ gate, component }) {
  selected = { gate, component };
  markSelected();
  field = "";
  points = [];
  at("details").hidden = false;
  at("details").dataset.of = gate ? "gate" : "component";
  at("subject").textContent = gate || component;
  for (const id of ["facts", "parameters", "gates", "message", "calls", "field", "log", "done"]) at(id).replaceChildren();
  at("plot").hidden = true;
  at("call").hidden = !mayAct || !gate || kindOf(gate) !== "rep";
  if (component) {
    showComponent(known["component " + component] || { activity: "stopped", parameters: [], gates: [] });
  } else {
    at("message").textContent = "waiting for a message";
    if (!at("call").hidden) showTemplate(gate);
  }
  connect();
}

async function showTemplate(gate) {
  at("request").value = "";
  const template = await act({ action: "template", gate });
  if (template.done && selected && selected.gate === gate && !at("request").value) at("request").value = template.text;
}

function deselect() {
  if (!selected) return;
  at("details").hidden = true;
  selected = null;
  field = "";
  markSelected();
  connect();
}

// The kind of a gate, `component.gate`, as its component has it.
function kindOf(name) {
  const gates = Object.entries(known).filter(([key, value]) => key.startsWith("component ") && value !== null);
  return gates.flatMap(([, value]) => value.gates).filter((gate) => gate.name === name).map((gate) => gate.kind)[0];
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
  ]);
  showParameters(value.parameters);
  showGates(value.gates);
}

// The rows of a table, made anew only if other things are listed: what is replaced while it is clicked at or edited
// notices nothing.
function rowsOf(table, names, make) {
  const listed = names.join("\n");
  if (table.dataset.listed !== listed || table.rows.length !== names.length) {
    table.dataset.listed = listed;
    table.replaceChildren(...names.map(make));
  }
  return [...table.rows];
}

function showGates(gates) {
  const rows = rowsOf(at("gates"), gates.map((gate) => gate.name), (gate) => {
    const [row, cell] = [document.createElement("tr"), document.createElement("td")];
    const name = element("button", gate.slice(selected.component.length + 1), { className: "link" });
    name.addEventListener("click", () => select({ gate }));
    cell.append(name);
    row.append(cell, element("td", ""), element("td", ""), element("td", ""));
    return row;
  });
  gates.forEach((gate, index) => {
    rows[index].className = gate.bad ? "bad" : "";
    [gate.kind, gate.rate, gate.trouble].forEach((text, cell) => { rows[index].cells[cell + 1].textContent = text; });
  });
}

function showParameters(parameters) {
  const rows = rowsOf(at("parameters"), parameters.map(([name]) => name), parameterRow);
  parameters.forEach(([, text], index) => {
    const shown = rows[index].cells[1].firstChild;
    if (shown !== document.activeElement) shown.value = text;
  });
}

// A value that can be changed, if pages may act.
function parameterRow(name) {
  const [row, cell] = [document.createElement("tr"), document.createElement("td")];
  const value = Object.assign(document.createElement("input"), { readOnly: !mayAct, ariaLabel: name });
  value.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || !mayAct) return;
    const parameter = `${selected.component}.${name}`;
    value.blur();
    perform({ action: "set", parameter, value: value.value });
  });
  cell.append(value);
  row.append(element("td", name), cell);
  return row;
}

function showLog(value) {
  if (!selected || value.component !== selected.component) return;
  const log = at("log");
  const isAtEnd = log.scrollHeight - log.scrollTop - log.clientHeight < 20;
  if (value.error !== undefined) log.textContent = value.error;
  // Programs colour what they print for terminals.
  for (const line of value.lines || []) log.append(element("div", line.replace(/\x1b\[[0-9;]*m/g, "")));
  while (log.childElementCount > LINES) log.firstElementChild.remove();
  if (isAtEnd) log.scrollTop = log.scrollHeight;
}

async function act(action) {
  const query = new URLSearchParams({ token });
  try {
    const answer = await fetch("/actions?" + query, { method: "POST", body: JSON.stringify(action) });
    return answer.ok ? await answer.json() : { done: false, text: await answer.text() };
  } catch (error) {
    return { done: false, text: String(error) };
  }
}

// Acts, and shows what has happened.
async function perform(action) {
  const subject = selected;
  at("done").className = "";
  at("done").textContent = "…";
  const done = await act(action);
  if (selected !== subject) return;
  at("done").className = done.done ? "" : "bad";
  at("done").textContent = done.text || "done";
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

at("close").addEventListener("click", deselect);
at("field").addEventListener("change", () => { field = at("field").value; points = []; connect(); });
at("restart").addEventListener("click", () => perform({ action: "restart", component: selected.component }));
at("stop").addEventListener("click", () => perform({ action: "stop", component: selected.component }));
at("send").addEventListener("click", () => perform({ action: "call", gate: selected.gate, request: at("request").value }));
at("actions").hidden = !mayAct;
