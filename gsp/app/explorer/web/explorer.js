// The explorer: points, parallel coordinates and the chosen design, all of one table (`spec`).
const { columns, names, colours, scale, parallel } = spec;
const at = (id) => document.getElementById(id);
const rows = names.map((_, row) => row);
const FONT = { family: "system-ui, sans-serif", size: 12, color: "#1f2933" };
const AXIS = { gridcolor: "#e8eaed", linecolor: "#b5bac2", zeroline: false, showline: true, ticks: "outside", tickcolor: "#b5bac2", automargin: true, exponentformat: "power" };
// Buttons are named, as plotly has others that lead to a server.
const CONFIG = { displaylogo: false, responsive: true, modeBarButtons: [["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"]] };
// More points than this are drawn by WebGL; parallel coordinates have at least this width per column.
const MANY = 2000, COLUMN = 105, NARROW = 600;
let chosen = null, spaces = [], scene = null, side = null;

// Numbers of a hover label or a list: as many digits as are read.
const number = (x) => (x === 0 || (Math.abs(x) >= 1e-4 && Math.abs(x) < 1e7) ? String(Number(x.toPrecision(6))) : x.toExponential(4));
const cell = (column, row) => {
  const value = columns[column].values[row];
  return !columns[column].numbers ? value : value === null ? columns[column].odd[row] : number(value);
};
// Plotly reads tags and entities in texts; only the subscripts of symbols are tags.
const escaped = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
const short = (text, most) => (text.length > most ? text.slice(0, most - 1) + "…" : text);
const label = (column, most = 60) => {
  const { label: text, arrow } = columns[column];
  return escaped(short(text, most)).replace(/_(\w+)/g, "<sub>$1</sub>") + (arrow && " " + arrow);
};
const numeric = columns.map((_, i) => i).filter((i) => columns[i].numbers);

// Place of the values of a column in [0, 1], and the values at places: logarithmic where it is.
const scales = new Map();
function measured(column) {
  if (!scales.has(column)) scales.set(column, measure(column));
  return scales.get(column);
}

function measure(column) {
  const { values, log } = columns[column], there = values.filter((x) => x !== null);
  let [low, high] = there.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
  const to = log ? Math.log : (x) => x, from = log ? Math.exp : (x) => x;
  const a = to(low), width = to(high) - a || 1;
  return {
    low, high,
    share: (x) => (to(x) - a) / width,
    value: (share) => (share <= 0 ? low : share >= 1 ? high : from(a * (1 - share) + to(high) * share)),
  };
}

// Marks between the ends of an axis of [0, 1]; a constant has one.
function marks(column, count) {
  const { low, high, value } = measured(column);
  if (!(low < high)) return [[low === high ? 0 : 0.5, Number.isFinite(low) ? number(low) : ""]];
  return [...Array(count + 1).keys()].map((i) => [i / count, String(Number(value(i / count).toPrecision(3)))]);
}

const channels = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
function shade(share) {
  const place = Math.min(Math.max(share, 0), 1) * (scale.length - 1), i = Math.min(Math.floor(place), scale.length - 2);
  const [a, b] = [channels(scale[i]), channels(scale[i + 1])];
  return "#" + a.map((x, k) => Math.round(x + (place - i) * (b[k] - x)).toString(16).padStart(2, "0")).join("");
}
const palette = scale.map((colour, i) => [i / (scale.length - 1), colour]);
const chosenColumn = (id) => Number(at(id).value);
function colour(row) {
  const by = chosenColumn("by"), value = columns[by].values[row];
  return value === null ? colours.grey : shade(measured(by).share(value));
}

// The rows within all ranges that are marked on parallel axes; null if none is marked.
function within() {
  if (!side || !side.ranges.some((range) => range)) return null;
  return new Set(parallel.rows.filter((_, line) => side.inside(line)));
}

function hovered(row) {
  const lines = spec.order.slice(0, spec.hovered).map((i) => `${label(i)}: ${escaped(short(cell(i, row), 60))}`);
  const more = spec.order.length - spec.hovered;
  return [`<b>${escaped(short(names[row], 60))}</b>`, ...lines, ...(more > 0 ? [`… ${more} more: click`] : [])].join("<br>");
}

function markers(list, marker, kept, more = {}) {
  const [x, y] = [chosenColumn("x"), chosenColumn("y")];
  const places = kept ? list.flatMap((row, i) => (kept.has(row) ? [i] : [])) : undefined;
  return {
    type: rows.length > MANY ? "scattergl" : "scatter", mode: "markers", marker, customdata: list,
    x: list.map((row) => columns[x].values[row]), y: list.map((row) => columns[y].values[row]),
    ...(kept ? { selectedpoints: places, unselected: { marker: { opacity: 0.06 } } } : {}), ...more,
  };
}

function traces() {
  const by = chosenColumn("by"), [x, y] = [chosenColumn("x"), chosenColumn("y")], kept = within();
  const placed = (row) => columns[x].values[row] !== null && columns[y].values[row] !== null;
  const there = rows.filter(placed), { share } = measured(by);
  const known = there.filter((row) => columns[by].values[row] !== null), unknown = there.filter((row) => columns[by].values[row] === null);
  const texts = (list) => ({ text: list.map(hovered), hoverinfo: "text" });
  const ticks = marks(by, 4), narrow = at("points").clientWidth < NARROW;
  const bar = { title: { text: label(by), side: narrow ? "top" : "right" }, tickvals: ticks.map(([place]) => place), ticktext: ticks.map(([, text]) => text), thickness: 10, outlinewidth: 0, ...(narrow ? { orientation: "h", y: 1.02, yanchor: "bottom", x: 0.5 } : { x: 1.01 }) };
  const front = spec.front.filter(placed), silent = { hoverinfo: "skip" };
  const joined = spec.objectives.length === 2 && [x, y].every((one, i) => one === spec.objectives[i]);
  const line = { mode: joined ? "lines+markers" : "markers", line: { color: colours.front, width: 1 } };
  const open = (size, colour, symbol = "circle-open") => ({ size, color: colour, symbol, line: { width: 1.6, color: colour } });
  const list = [
    markers(unknown, { color: colours.grey, size: 6, symbol: "x-thin", line: { width: 1.2, color: colours.grey } }, kept, { name: "no colour", showlegend: unknown.length > 0, ...texts(unknown) }),
    markers(known, { size: 7, color: known.map((row) => share(columns[by].values[row])), colorscale: palette, cmin: 0, cmax: 1, colorbar: bar, line: { width: 0.5, color: "#fff" } }, kept, { name: "designs", showlegend: false, ...texts(known) }),
    markers(front, open(10, colours.front), kept, { name: "front", ...line, ...silent }),
    markers([spec.knee].filter(placed), open(14, colours.knee, "diamond-open"), null, { name: "knee", ...silent }),
    markers([chosen].filter((row) => row !== null && placed(row)), open(19, "#1f2933"), null, { name: "shown", ...silent }),
  ];
  return list;
}

function axis(column) {
  const { log, side } = columns[column];
  return { ...AXIS, type: log ? "log" : "linear", autorange: side === "lower" ? "reversed" : true, title: { text: label(column), standoff: 8 } };
}

let drawn = Promise.resolve(), wasNarrow = null;
function draw() {
  const [x, y, by] = ["x", "y", "by"].map(chosenColumn);
  const narrow = at("points").clientWidth < NARROW, anew = wasNarrow !== null && narrow !== wasNarrow;
  wasNarrow = narrow;
  const layout = {
    font: FONT, margin: { l: 10, r: narrow ? 8 : 10, t: narrow ? 10 : 26, b: 10 }, hovermode: "closest", dragmode: narrow ? false : "zoom", uirevision: `${x} ${y}`,
    hoverlabel: { bgcolor: "#fff", bordercolor: "#52606d", align: "left", font: { ...FONT } },
    legend: { orientation: "h", x: 0, y: narrow ? -0.22 : 1.01, yanchor: narrow ? "top" : "bottom", itemclick: false, itemdoubleclick: false },
    paper_bgcolor: "#fff", plot_bgcolor: "#fff", xaxis: axis(x), yaxis: axis(y),
  };
  const gaps = [...new Set([x, y, by])].map((i) => columns[i].gap).filter(Boolean);
  const lost = rows.filter((row) => columns[x].values[row] === null || columns[y].values[row] === null).length;
  if (lost) gaps.push(`${lost} of ${rows.length} designs have no place here`);
  at("gaps").textContent = gaps.join(" · ");
  drawn = drawn.then(async () => {
    // A colour bar that is turned leaves its texts.
    if (anew) Plotly.purge("points");
    await Plotly.react("points", traces(), layout, CONFIG);
    at("points").removeAllListeners("plotly_click");
    at("points").on("plotly_click", ({ points }) => choose(points[0].customdata));
  });
  return drawn;
}

function drawLines() {
  side.paint(parallel.rows.map(colour), parallel.rows.indexOf(chosen));
}

function parallelAxes() {
  return parallel.columns.map((column, i) => {
    const { numbers, side: better, label: text, arrow } = columns[column];
    const place = (height) => (better === "lower" ? 1 - height : height);
    const own = numbers ? marks(column, 4).map(([height, mark]) => [place(height), mark]) : parallel.marks[i];
    return { label: `${text} ${arrow}`.trim(), marks: own.map(([height, mark]) => [height, short(mark, 12)]) };
  });
}

function describeRanges() {
  const kept = within(), left = rows.length - parallel.rows.length;
  const missing = left ? `${left} of ${rows.length} designs have no line: a value is infinite or undefined` : "";
  const parts = side.ranges.flatMap((range, i) => {
    if (!range) return [];
    const column = parallel.columns[i], { label: text, numbers, values } = columns[column];
    const list = [...kept].map((row) => values[row]);
    if (!list.length) return [text];
    return numbers ? [`${text} ${number(list.reduce((a, b) => Math.min(a, b)))} to ${number(list.reduce((a, b) => Math.max(a, b)))}`] : [`${text} ${[...new Set(list)].join(", ")}`];
  });
  at("all").hidden = kept === null;
  const state = kept ? `${kept.size} of ${rows.length} designs: ${parts.join(" · ")}` : "Drag along an axis to mark a range; other designs are dimmed.";
  at("kept").textContent = [state, missing].filter(Boolean).join(" · ");
}

function entry(row, list) {
  const [term, value] = list.map((text, i) => Object.assign(document.createElement(i ? "dd" : "dt"), { textContent: text }));
  return [term, value];
}

function anchors(space) {
  const table = at("anchors").querySelector("table");
  const line = (cells, kind) => {
    const row = document.createElement("tr");
    row.append(...cells.map((text, i) => Object.assign(document.createElement(i ? kind : "th"), { textContent: text })));
    return row;
  };
  const unit = space.unit ? ` [${space.unit}]` : "";
  const words = ["x", "y", "z"].flatMap((axis) => [`base ${axis}`]).concat(["x", "y", "z"].map((axis) => `platform ${axis}`));
  table.replaceChildren(line([`leg${unit}`, ...words], "th"), ...space.base.map((point, i) => line([`${i + 1} ${space.legs[i]}`, ...point, ...space.platform[i]], "td")));
}

let Scene = null;
function showSpace(row) {
  const space = spaces[row], there = space !== null && typeof space === "object";
  at("stage").hidden = at("anchors").hidden = !there;
  at("reason").textContent = there || !sources.spaces ? "" : space ?? `Not on this page, which has ${spec.drawn} of ${rows.length} designs in space.`;
  if (!there) return;
  anchors(space);
  if (!Scene) return;
  const place = { ...space.place, colour: colour(row) };
  const shown = { numbers: true, names: false, axes: true, ellipsoid: true, screw: false };
  if (!scene) scene = new Scene(document.querySelector(".gsp-scene"), { drawing: space.drawing, place, shown, view: "space" });
  else {
    scene.build(space.drawing, place);
    if (!scene.touched) scene.look(scene.named);
  }
}

function choose(row) {
  chosen = row;
  at("name").textContent = names[row];
  at("values").replaceChildren(...spec.order.flatMap((i) => entry(row, [`${columns[i].label} ${columns[i].arrow}`.trim(), cell(i, row)])));
  document.querySelector(".facts").scrollTop = 0;
  const place = spec.front.indexOf(row);
  at("step").textContent = place < 0 ? "front" : `front ${place + 1} of ${spec.front.length}`;
  at("back").disabled = place === 0;
  at("next").disabled = place === spec.front.length - 1;
  showSpace(row);
  if (side) drawLines();
  return draw();
}

function step(by) {
  const place = spec.front.indexOf(chosen);
  choose(place < 0 ? spec.knee : spec.front[place + by]);
}

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}
const address = (code) => URL.createObjectURL(new Blob([code], { type: "text/javascript" }));

async function load() {
  const script = document.createElement("script");
  script.src = address(await unpacked(sources.plotly));
  await new Promise((done, failed) => Object.assign(script, { onload: done, onerror: failed }) && document.head.append(script));
  if (!sources.spaces) return;
  spaces = JSON.parse(await unpacked(sources.spaces));
  const imports = {};
  for (const [name, text] of Object.entries(sources.scene)) imports[name] = address(await unpacked(text));
  document.head.append(Object.assign(document.createElement("script"), { type: "importmap", textContent: JSON.stringify({ imports }) }));
  ({ Scene } = await import("gsp-scene"));
}

(async () => {
  for (const id of ["x", "y", "by"]) {
    at(id).append(...numeric.map((i) => new Option(columns[i].label, i, false, i === spec[id])));
    at(id).addEventListener("change", () => {
      choose(chosen);
    });
  }
  at("back").addEventListener("click", () => step(-1));
  at("next").addEventListener("click", () => step(1));
  at("name").textContent = "…";
  at("lines").style.minWidth = `${COLUMN * parallel.columns.length}px`;
  side = new Parallel(at("lines"), parallelAxes(), parallel.heights, () => {
    describeRanges();
    draw();
  });
  await load();
  await choose(spec.knee);
  describeRanges();
  at("all").addEventListener("click", () => side.clear());
  let width = at("points").clientWidth;
  new ResizeObserver(() => {
    if (at("points").clientWidth === width) return;
    width = at("points").clientWidth;
    draw();
  }).observe(at("points"));
  new ResizeObserver(() => side.resize()).observe(at("lines"));
})().catch((error) => {
  at("gaps").textContent = `This browser cannot draw the page: ${error.message ?? "a script was refused"}.`;
  throw error;
});
