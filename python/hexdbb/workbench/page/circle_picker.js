// A button for each circle and feed: its error as a number and a bar, the one that is shown pressed.
export default {
  props: ["circles"],
  template: `
    <div class="wb-picker" role="group" aria-label="Circle and feed">
      <button v-for="(each, index) in circles" type="button" data-mark="circle" :class="{ 'wb-current': index === current }"
              :aria-pressed="index === current" @click="$emit('pick', index)">
        <span class="wb-circle-name"><span>{{ each.name }}</span><span class="wb-small">{{ each.feed }}</span></span>
        <span class="wb-bar" :style="{ '--part': largest ? (sizes[index] ?? 0) / largest : 0 }"></span>
        <span class="wb-circle-rms">{{ sizes.length ? sizes[index].toFixed(2) + " µm" : "" }}</span>
      </button>
    </div>`,
  data: () => ({ sizes: [], largest: 0, current: -1 }),
  mounted() {
    this.$emit("ready");
  },
  methods: {
    show(sizes, largest, current) {
      Object.assign(this, { sizes, largest, current });
    },
  },
};
