// The switch of one effect. It keeps its own state: a switch of the page's framework has the whole page rendered again
// when it is turned, before the curves are drawn.
export default {
  props: ["label", "mark", "first"],
  template: `<q-toggle dense :model-value="on" :aria-label="label" :data-mark="mark" @update:model-value="turn" />`,
  data() {
    return { on: this.first };
  },
  methods: {
    set(on) {
      this.on = on;
    },
    turn(on) {
      this.on = on;
      this.$emit("turn", on);
    },
  },
};
