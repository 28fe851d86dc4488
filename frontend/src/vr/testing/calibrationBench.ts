/** Calibrations of many scripted people, with the inverse kinematics of the headset's page. */
import { loadMujoco } from "@shared/avatar/mujoco";
import { OwnBody, skeletonModel } from "../bodies/ownBody";
import { type CalibratedPerson, calibrate, type MakeBody } from "./scriptedCalibration";

/** What is compared of one calibration. */
export interface Found {
  readonly statureM: number;
  readonly spanM: number | null;
  readonly residualsM: Readonly<Record<string, number>>;
  readonly notices: readonly string[];
  readonly asked: readonly string[];
  readonly wasRepeated: boolean;
  readonly tookS: number;
}

export async function calibrateAll(people: readonly CalibratedPerson[]): Promise<Found[]> {
  const mujoco = await loadMujoco();
  const makeBody: MakeBody = ({ statureM, segmentsM }) => {
    const model = skeletonModel(mujoco, statureM, segmentsM);
    const body = new OwnBody(mujoco, model);
    return {
      errorsOf(goals) {
        body.follow(goals);
        return body.goalErrorsM;
      },
      dispose() {
        body.dispose();
        model.delete();
      },
    };
  };
  return people.map((person) => {
    const { calibration, asked, wasRepeated, tookS } = calibrate(person, makeBody);
    const { statureM, spanM, residualsM, notices } = calibration;
    return { statureM, spanM, residualsM, notices, asked, wasRepeated, tookS };
  });
}
