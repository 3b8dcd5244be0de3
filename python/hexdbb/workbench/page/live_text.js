// A text that changes often: a component of its own, so that the browser renders it alone and not the page around it.
export default {
  props: ["first"],
  template: `<span>{{ text }}</span>`,
  data() {
    return { text: this.first };
  },
  mounted() {
    this.$emit("ready");
  },
  methods: {
    set(text) {
      this.text = text;
    },
  },
};
