/** The session in the headset: everything between the button Enter and the end of the visit. */
export { Vr, type VrParts } from "./vr";
