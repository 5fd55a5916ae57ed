// Pictures and films of the scene, made in the browser: PNG, GIF, and video where it records one.
import { gif } from "gsp-scene/gif.js";

const PAPER = "#f4f7f9", FRAMES_PER_SECOND = 20, LONGEST_SIDE = 720;
// What is not encoded yet when a recorder stops is lost, so the last picture stays for so long [ms].
const HELD = 1000;
// How long to wait for the duration of a video [ms].
const LONGEST_READING = 30000;
// A video that takes so many times as long as the motion is not what was recorded.
const SLOWER = 1.25;

export function save(blob, name) {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// What is seen as one picture: background, scene, and the labels, which are not in the canvas.
export function snapshot(scene, scale = window.devicePixelRatio, canvas = document.createElement("canvas")) {
  const { clientWidth: width, clientHeight: height } = scene.root;
  [canvas.width, canvas.height] = [Math.round(width * scale), Math.round(height * scale)];
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  pen.fillStyle = PAPER;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  scene.render();
  pen.drawImage(scene.root.children[0], 0, 0, canvas.width, canvas.height);
  pen.scale(scale, scale);
  const corner = scene.root.getBoundingClientRect();
  for (const label of scene.root.children[1].children) {
    if (label.style.display === "none") continue;
    const box = label.getBoundingClientRect(), style = getComputedStyle(label);
    const [x, y] = [box.left - corner.left, box.top - corner.top];
    pen.beginPath();
    pen.roundRect(x, y, box.width, box.height, parseFloat(style.borderRadius) || 0);
    pen.fillStyle = style.backgroundColor;
    pen.fill();
    pen.strokeStyle = style.borderColor;
    if (parseFloat(style.borderWidth)) pen.stroke();
    pen.fillStyle = style.color;
    pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(label.textContent, x + box.width / 2, y + box.height / 2);
  }
  return canvas;
}

// Browsers draw pages that are not in view about once per second or not at all: the film would wait.
function inView() {
  if (document.hidden) throw new Error("the page was not in view, where browsers draw no film; keep it in view");
}

export async function film(scene, kind, places, seconds, name) {
  const { clientWidth: width, clientHeight: height } = scene.root;
  const scale = Math.min(1, LONGEST_SIDE / Math.max(width, height));
  const canvas = document.createElement("canvas");
  const delay = (1000 * seconds) / places.length;
  const [blob, all] = await (kind === "gif" ? animation : video)(scene, canvas, places, scale, delay);
  save(blob, `${name}.${kind === "gif" ? "gif" : blob.type.includes("mp4") ? "mp4" : "webm"}`);
  if (kind !== "gif") await checked(blob, all, seconds);
  return blob.size;
}

// At most so many frames per second; more samples than that are left out.
function chosen(places, delay) {
  const step = Math.max(1, Math.round(1000 / FRAMES_PER_SECOND / delay));
  const last = places.length - 1;
  return [places.filter((_, i) => i % step === 0 || i === last), delay * step];
}

// The film, and how many seconds of it there have to be, where some can be lost.
async function animation(scene, canvas, places, scale, delay) {
  const frames = [], [shown, pause] = chosen(places, delay);
  for (const place of shown) {
    inView();
    scene.move(place);
    const { width, height } = snapshot(scene, scale, canvas);
    frames.push(canvas.getContext("2d").getImageData(0, 0, width, height).data);
    await new Promise((done) => setTimeout(done));
  }
  return [gif(frames, canvas.width, canvas.height, pause), 0];
}

async function video(scene, canvas, places, scale, delay) {
  if (!window.MediaRecorder) throw new Error("this browser records no video");
  const [shown, pause] = chosen(places, delay);
  snapshot(scene, scale, canvas);
  const stream = canvas.captureStream(), parts = [];
  const recorder = new MediaRecorder(stream, { videoBitsPerSecond: 4e6 });
  recorder.ondataavailable = (event) => parts.push(event.data);
  const ended = new Promise((done) => (recorder.onstop = done));
  recorder.start();
  const start = performance.now();
  const show = async (place) => {
    inView();
    scene.move(place);
    snapshot(scene, scale, canvas);
    await new Promise((done) => setTimeout(done, pause));
  };
  for (const place of shown) await show(place);
  const motion = performance.now() - start;
  while (performance.now() < start + motion + HELD) await show(shown.at(-1));
  recorder.stop();
  await ended;
  stream.getTracks().forEach((track) => track.stop());
  return [new Blob(parts, { type: recorder.mimeType }), (motion - pause) / 1000];
}

// A busy browser can lose the end of a video, and can also be too busy to read how long it is.
// A slow one shows the motion slower than it is.
async function checked(blob, all, seconds) {
  const has = await duration(blob), motion = has - HELD / 1000;
  if (has >= all && motion < SLOWER * seconds) return;
  let part = "could not read how long the video is";
  if (has >= all) part = `made a video of ${motion.toFixed(1)} s of a motion of ${seconds.toFixed(1)} s`;
  else if (has) part = `recorded ${has.toFixed(1)} s of ${all.toFixed(1)} s`;
  throw new Error(`the browser was too slow and ${part}; a GIF has all pictures, at the right times`);
}

// The duration of a video [s], which is known at its end only; 0 where it stays unknown.
function duration(blob) {
  const player = document.createElement("video");
  player.muted = true;
  player.src = URL.createObjectURL(blob);
  return new Promise((done) => {
    const end = () => done(Number.isFinite(player.duration) ? player.duration : 0);
    player.onloadedmetadata = () => (player.currentTime = 1e6);
    player.onseeked = player.onerror = end;
    setTimeout(end, LONGEST_READING);
  }).finally(() => URL.revokeObjectURL(player.src));
}
