// The scene as an element of the page: what the server calls is passed on.
import { Scene } from "gsp-scene";

export default {
  template: `<div class="gsp-scene" tabindex="0" role="img" :aria-label="label"></div>`,
  props: { label: String, drawing: Object, place: Object, shown: Object, view: String },

  mounted() {
    try {
      this.view3d = new Scene(this.$el, this.$props);
    } catch (error) {
      console.warn(error); // no WebGL: the page states it, and the numbers work
    }
  },

  beforeUnmount() {
    this.view3d?.remove();
  },

  methods: {
    call(name, ...words) {
      this.view3d?.[name](...words);
    },
    // "" for a film that was saved, else why it was not.
    async film(...words) {
      if (!this.view3d) return "this browser has no WebGL";
      try {
        await this.view3d.film(...words);
        return "";
      } catch (error) {
        return error.message;
      }
    },
  },
};
