// Quasar gives role, name and values to the root of a slider, and the focus to a part of it, so that
// screen readers announce nothing. Here they are moved to what has the focus. Quasar writes to the
// root what changes, which is moved too.
const ROOT = ".q-slider", FOCUSED = ".q-slider__track-container";
const taken = new WeakMap(); // what each root has had: a slider that is enabled gets another part

function move(root) {
  const part = root.querySelector(FOCUSED), known = taken.get(root) ?? new Map();
  taken.set(root, known);
  for (const { name, value } of [...root.attributes]) {
    if (name !== "role" && !name.startsWith("aria-")) continue;
    known.set(name, value);
    root.removeAttribute(name);
  }
  // From the class: what is removed from the root already is not seen to be removed again.
  known.delete("aria-disabled");
  if (root.classList.contains("disabled")) known.set("aria-disabled", "true");
  else part?.removeAttribute("aria-disabled");
  for (const [name, value] of known) part?.setAttribute(name, value);
}

function follow(changes) {
  const roots = new Set();
  for (const { type, target, addedNodes } of changes) {
    if (type === "attributes" && target.matches(ROOT)) roots.add(target);
    if (!addedNodes.length) continue;
    const around = target.closest(ROOT);
    for (const one of around ? [around] : target.querySelectorAll(ROOT)) roots.add(one);
  }
  roots.forEach(move);
}

const attributeFilter = [
  "role", "class", "aria-label", "aria-valuenow", "aria-valuemin", "aria-valuemax", "aria-orientation",
  "aria-disabled",
];
new MutationObserver(follow).observe(document.body, { subtree: true, childList: true, attributeFilter });
document.querySelectorAll(ROOT).forEach(move);
