// The slider of one value. While it is dragged the next value is sent when the curves of the one before are drawn: charts
// follow as fast as this computer can, and never lag behind.
const ANSWER_MS = 300; // without an answer for so long, of a value that was refused, the next one is sent

export default {
  props: ["name", "label", "mark", "unit", "known", "low", "high", "step", "first"],
  template: `
    <div class="wb-value">
      <div class="wb-value-name">{{ name }}</div>
      <div class="wb-value-number">{{ Number(value.toPrecision(4)) }} {{ unit }}</div>
      <q-slider dense :model-value="value" :min="low" :max="high" :step="step" :aria-label="label" :data-mark="mark"
                @update:model-value="drag" @pan="pan" />
      <div class="wb-small wb-value-known">{{ known }}</div>
    </div>`,
  data() {
    return { value: this.first };
  },
  created() {
    this.shown = () => {
      this.isAwaited = false;
      this.send();
    };
    window.addEventListener("hexdbb-shown", this.shown);
  },
  beforeUnmount() {
    clearTimeout(this.late);
    window.removeEventListener("hexdbb-shown", this.shown);
  },
  methods: {
    set(value) {
      if (!this.isHeld) this.value = value;
    },
    pan(phase) {
      this.isHeld = phase === "start";
    },
    drag(value) {
      this.value = value;
      this.next = value;
      this.send();
    },
    send() {
      if (this.next === undefined || this.isAwaited) return;
      const value = this.next;
      this.next = undefined;
      this.isAwaited = true;
      clearTimeout(this.late);
      this.late = setTimeout(this.shown, ANSWER_MS);
      this.$emit("drag", value);
    },
  },
};
