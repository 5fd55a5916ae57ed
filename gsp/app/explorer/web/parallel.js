// Parallel coordinates: lines on a canvas, axes with their ranges over it. Heights are in [0, 1].
const SVG = "http://www.w3.org/2000/svg";
const PAD = { left: 26, right: 84, top: 46, bottom: 12 };
// Width of what is dragged along an axis, and the least range [pixels, height].
const GRIP = 34, LEAST = 0.012, STEP = 0.05;
// Pixels of a letter of a label.
const LETTER = 7.2;

function element(name, attributes, text = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

class Parallel {
  // `axes`: label and marks of each; `heights`: by axes, then lines. `changed` is called on new ranges.
  constructor(root, axes, heights, changed) {
    Object.assign(this, { root, axes, heights, changed, ranges: axes.map(() => null), lines: [], chosen: -1 });
    root.innerHTML = "<canvas></canvas><svg></svg>";
    [this.canvas, this.svg] = root.children;
  }

  // Give lines their colours; `chosen` is the place of a line that is drawn on top, or −1.
  paint(colours, chosen) {
    this.colours = colours;
    this.chosen = chosen;
    this.resize();
  }

  resize() {
    this.width = this.root.clientWidth;
    this.height = this.root.clientHeight;
    const dots = window.devicePixelRatio;
    [this.canvas.width, this.canvas.height] = [this.width * dots, this.height * dots];
    this.svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    this.drawAxes();
    this.drawLines();
  }

  x(axis) {
    return PAD.left + (axis * (this.width - PAD.left - PAD.right)) / Math.max(this.axes.length - 1, 1);
  }

  y(height) {
    return PAD.top + (1 - height) * (this.height - PAD.top - PAD.bottom);
  }

  inside(line) {
    return this.ranges.every((range, i) => !range || (range[0] <= this.heights[i][line] && this.heights[i][line] <= range[1]));
  }

  drawLines() {
    const pen = this.canvas.getContext("2d"), dots = window.devicePixelRatio;
    pen.setTransform(dots, 0, 0, dots, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    const stroke = (line, colour, width, alpha) => {
      Object.assign(pen, { strokeStyle: colour, lineWidth: width, globalAlpha: alpha });
      pen.beginPath();
      this.heights.forEach((heights, i) => pen.lineTo(this.x(i), this.y(heights[line])));
      pen.stroke();
    };
    const all = [...this.colours.keys()], kept = all.filter((line) => this.inside(line));
    if (kept.length < all.length) all.forEach((line) => stroke(line, "#c5ccd3", 1, 0.18));
    kept.forEach((line) => stroke(line, this.colours[line], 1.1, 0.75));
    if (this.chosen < 0) return;
    stroke(this.chosen, "#fff", 5, 0.9);
    stroke(this.chosen, "#1f2933", 2.4, 1);
  }

  drawAxes() {
    const focus = [...this.svg.querySelectorAll(".grip")].indexOf(document.activeElement);
    this.svg.replaceChildren(...this.axes.map((axis, i) => this.drawAxis(axis, i)));
    if (focus >= 0) this.svg.querySelectorAll(".grip")[focus].focus();
  }

  drawAxis({ label, marks }, i) {
    const group = element("g", { transform: `translate(${this.x(i)} 0)` }), last = i === this.axes.length - 1;
    const [low, high] = [this.y(0), this.y(1)], anchor = i === 0 ? "start" : last ? "end" : "middle";
    const shift = i === 0 ? 4 - PAD.left : last ? PAD.right - 4 : 0;
    const most = Math.max(Math.floor((this.x(1) - this.x(0)) / LETTER), 8);
    lines(label, most).forEach((text, k, all) => group.append(element("text", { class: "label", x: shift, y: high - 12 - 14 * (all.length - 1 - k), "text-anchor": anchor }, text)));
    group.append(element("line", { x1: 0, x2: 0, y1: low, y2: high, class: "axis" }));
    for (const [height, text] of marks) {
      group.append(element("line", { x1: 0, x2: 4, y1: this.y(height), y2: this.y(height), class: "axis" }));
      group.append(element("text", { class: "mark", x: 7, y: this.y(height) + 4 }, text));
    }
    const range = this.ranges[i];
    if (range) group.append(element("rect", { class: "range", x: -5, width: 10, y: this.y(range[1]), height: Math.max(this.y(range[0]) - this.y(range[1]), 2), rx: 3 }));
    const grip = element("rect", { class: "grip", x: -GRIP / 2, width: GRIP, y: high - 6, height: low - high + 12, tabindex: 0, role: "button" });
    const state = range ? `${Math.round(100 * range[0])} to ${Math.round(100 * range[1])} % of the axis` : "no range";
    grip.setAttribute("aria-label", `${label}: ${state}; arrows move the lower end, with Shift the upper one, Escape removes the range`);
    grip.addEventListener("pointerdown", (event) => this.drag(event, i));
    grip.addEventListener("keydown", (event) => this.key(event, i));
    group.append(grip);
    return group;
  }

  place(event) {
    const { top, height } = this.svg.getBoundingClientRect();
    const y = ((event.clientY - top) / height) * this.height;
    return Math.min(Math.max(1 - (y - PAD.top) / (this.height - PAD.top - PAD.bottom), 0), 1);
  }

  // A range from where the pointer was pressed to where it is; a click removes it.
  drag(event, i) {
    const start = this.place(event), signal = new AbortController(), options = { signal: signal.signal };
    event.preventDefault();
    const moved = (now) => {
      const stop = this.place(now);
      this.set(i, Math.abs(stop - start) < LEAST ? null : [Math.min(start, stop), Math.max(start, stop)]);
    };
    window.addEventListener("pointermove", moved, options);
    for (const end of ["pointerup", "pointercancel"]) {
      window.addEventListener(end, (now) => {
        signal.abort();
        if (end === "pointerup") moved(now);
      }, options);
    }
  }

  key(event, i) {
    const way = { ArrowUp: STEP, ArrowDown: -STEP }[event.key];
    if (event.key !== "Escape" && !way) return;
    event.preventDefault();
    const next = [...(this.ranges[i] ?? [0, 1])], end = event.shiftKey ? 1 : 0;
    next[end] = Math.min(Math.max(next[end] + way, end ? next[0] + STEP : 0), end ? 1 : next[1] - STEP);
    this.set(i, event.key === "Escape" || (next[0] <= 0 && next[1] >= 1) ? null : next);
  }

  set(i, range) {
    this.ranges[i] = range;
    this.drawAxes();
    this.drawLines();
    this.changed();
  }

  clear() {
    this.ranges.fill(null);
    this.drawAxes();
    this.drawLines();
    this.changed();
  }
}

// A text in at most two lines of so many letters.
function lines(text, most) {
  if (text.length <= most) return [text];
  const place = text.lastIndexOf(" ", most), cut = place > 0 ? place : most;
  const rest = text.slice(cut).trim();
  return [text.slice(0, cut), rest.length > most ? rest.slice(0, most - 1) + "…" : rest];
}
