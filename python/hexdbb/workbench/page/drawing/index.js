// What the linked charts of a circle are drawn with.
export * from "./lines.js";
export * from "./options.js";
export * from "./overlay.js";
export * from "./style.js";
