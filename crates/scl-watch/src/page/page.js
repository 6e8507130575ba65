// Shows what the server sends: the picture once, and then what has changed in it. Texts of the system become text nodes;
// only the picture, which the server has drawn and escaped, becomes elements.
const history = new Map(); // the rates of each row, one for each half second
const HISTORY = 120, TICK = 500, POINTS = 3000;
let known = {}, parts = {}, drawn = "", source = null, zoom = null, isNew = false;

function connect() {
  if (source) source.close();
  const query = new URLSearchParams({ token, view: at("view").value });
  for (const [name, value] of Object.entries({ ...selected, field, ...playQuery() })) {
    if (value || value === 0) query.set(name, value);
  }
  source = new EventSource("/events?" + query);
  source.addEventListener("state", (event) => show(JSON.parse(event.data)));
  source.addEventListener("gate", (event) => showGate(JSON.parse(event.data)));
  source.addEventListener("log", (event) => showLog(JSON.parse(event.data)));
  source.addEventListener("open", () => { isNew = true; });
  source.addEventListener("error", () => {
    at("problems").className = "away";
    at("problems").textContent = "no connection to scl watch";
  });
}

function show(values) {
  if (isNew) {
    // The first values of a connection are all that there are.
    known = {};
    isNew = false;
  }
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
    if (kind === "time") showTime(value);
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
    const { gate, component, stack } = part.dataset;
    if (gate || component || stack) {
      const act = (event) => { event.stopPropagation(); if (stack) openStacks(); else select(part.dataset); };
      part.classList.toggle("selected", isSelected(part));
      part.addEventListener("click", act);
      part.addEventListener("keydown", (event) => { if (event.key === "Enter") act(event); });
    }
  }
  resize();
  search();
}

// Shows each component of a kind, with its gates if the stacks have them.
function openStacks() {
  at("view").value = at("picture").querySelector(".row") ? "1" : "2";
  at("view").dispatchEvent(new Event("change"));
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
  badge.textContent = ["running", "stopped", null].includes(value.state) ? "" : value.state;
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

function search() {
  const wanted = at("search").value.trim().toLowerCase();
  for (const block of at("picture").querySelectorAll(".block")) {
    const { component, stack } = block.dataset;
    const texts = [component || stack, ...[...block.querySelectorAll("[data-gate]")].map((it) => it.dataset.gate)];
    block.classList.toggle("dim", wanted !== "" && !texts.some((text) => text.toLowerCase().includes(wanted)));
  }
}

at("search").addEventListener("input", search);
at("view").addEventListener("change", () => { deselect(); history.clear(); connect(); });
at("larger").addEventListener("click", () => { zoom = Math.min(zoom * 1.25, 4); resize(); });
at("smaller").addEventListener("click", () => { zoom = Math.max(zoom / 1.25, 0.1); resize(); });
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") { at("search").value = ""; search(); deselect(); }
  if (event.target.matches("input, select, textarea")) return;
  if (event.key === "/") { event.preventDefault(); at("search").focus(); }
  if (event.key === "+") at("larger").click();
  if (event.key === "-") at("smaller").click();
});
connect();
