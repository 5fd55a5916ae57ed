// While there is no connection nothing can be changed, and a note states it: the server would not
// receive what is done. NiceGUI keeps in its own note (#popup) whether there is a connection.
const popup = document.getElementById("popup");
const note = document.getElementById("gsp-offline");
let focused = null;

function follow() {
  const offline = popup.ariaHidden === "false";
  if (offline === !note.hidden) return;
  if (offline) focused = document.activeElement; // what cannot be operated loses the focus
  for (const part of document.body.children) if (part !== note) part.inert = offline;
  note.hidden = !offline;
  note.textContent = offline ? note.dataset.text : "";
  if (!offline && focused?.isConnected) focused.focus({ preventScroll: true });
}

new MutationObserver(follow).observe(popup, { attributes: true, attributeFilter: ["aria-hidden"] });
follow();
