// While there is no connection nothing can be changed, and a note states it: the server would not
// receive what is done. NiceGUI keeps in its own note (#popup) that a connection was lost, and shows
// nothing where a page that was loaded cannot connect at all.
const popup = document.getElementById("popup");
const note = document.getElementById("gsp-offline");
let focused = null;
let refused = false; // the last try to connect failed

function follow() {
  const offline = refused || popup.ariaHidden === "false";
  if (offline === !note.hidden) return;
  if (offline) focused = document.activeElement; // what cannot be operated loses the focus
  for (const part of document.body.children) if (part !== note) part.inert = offline;
  note.hidden = !offline;
  note.textContent = offline ? note.dataset.text : "";
  if (!offline && focused?.isConnected) focused.focus({ preventScroll: true });
}

function tried(failed) {
  refused = failed;
  follow();
}

// The socket is made when the page is mounted, after this script.
const waiting = setInterval(() => {
  if (!window.socket) return;
  clearInterval(waiting);
  window.socket.on("connect_error", () => tried(true));
  window.socket.on("connect", () => tried(false));
}, 100);

new MutationObserver(follow).observe(popup, { attributes: true, attributeFilter: ["aria-hidden"] });
follow();
