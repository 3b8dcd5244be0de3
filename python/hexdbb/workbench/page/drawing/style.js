// Colours and sizes that the charts share.

export const INK = "#1F2933", FAINT = "#D9D9D9", MUTED = "#595959", FITTED = "#767676";
export const TEXT = { color: INK, fontSize: 12 };
export const TURN = 360;
export const POLAR_SHARE = 0.78; // of the polar chart's half width: outside stand the angles
