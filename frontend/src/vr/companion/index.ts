/** A companion: another person in the participant's room, moved by a performer in the lab. */
export { type CompanionBody, CompanionLink } from "./link";
