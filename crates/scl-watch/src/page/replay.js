// A recording: the position, and playing on from there.
const replays = document.body.dataset.controls === "replay";
let position = 0, plays = true, dragging = false;

// What the stream of events is asked for.
function playQuery() {
  return replays ? { from: position, speed: plays ? at("speed").value : 0 } : {};
}

function showTime({ at: now, length, date }) {
  position = now;
  const slider = at("position");
  slider.max = length;
  if (!dragging) slider.value = now;
  at("time").textContent = `${now.toFixed(1)} of ${length.toFixed(1)} s, ${new Date(date).toLocaleTimeString()}`;
}

function goTo(time) {
  position = time;
  points = [];
  connect();
}

function togglePlay() {
  plays = !plays;
  at("play").textContent = plays ? "⏸" : "▶";
  connect();
}

at("player").hidden = !replays;
at("position").addEventListener("pointerdown", () => { dragging = true; });
at("position").addEventListener("pointerup", () => { dragging = false; });
at("position").addEventListener("input", () => goTo(Number(at("position").value)));
at("play").addEventListener("click", togglePlay);
at("speed").addEventListener("change", () => connect());
document.addEventListener("keydown", (event) => {
  if (!replays || event.key !== " " || event.target.matches("input, select, textarea, button")) return;
  event.preventDefault();
  togglePlay();
});
