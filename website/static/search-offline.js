// Browsers start no worker in a page that is opened from a folder (file:). There the search runs
// in a hidden frame instead.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super()
      const frame = document.createElement("iframe")
      frame.hidden = true
      document.body.append(frame)
      this.inner = frame.contentWindow
      this.inner.postMessage = data => this.dispatchEvent(new MessageEvent("message", { data }))
      this.loaded = new Promise((done, failed) => {
        const script = this.inner.document.createElement("script")
        script.onload = done
        script.onerror = failed
        script.src = url
        this.inner.document.body.append(script)
      })
    }
    postMessage(data) {
      const event = new MessageEvent("message", { data })
      this.loaded.then(() => this.inner.dispatchEvent(event))
    }
  }
}
