"""Computes the forces of the actuators of designs in MuJoCo, for a motion of the platform: the loops are cut, and the forces that close
them are solved together with those of the actuators.

Usage: mujoco_forces.py MOTION.json MODEL.xml...
"""

import json
import sys

import mujoco
import numpy as np

# Step of the differences by which the closures change along the motion [s].
STEP = 1e-6


def closures(model, data):
    """Returns the rows of the velocities by which the loops open."""
    rows = []
    for index in range(model.neq):
        leg, platform = model.eq_obj1id[index], model.eq_obj2id[index]
        anchor = model.eq_data[index, 3:6] if model.eq_type[index] == mujoco.mjtEq.mjEQ_WELD else model.eq_data[index, :3]
        body = platform if model.eq_type[index] == mujoco.mjtEq.mjEQ_WELD else leg
        point = data.xpos[body] + data.xmat[body].reshape(3, 3) @ anchor
        linear, angular = np.zeros((2, 3, model.nv)), np.zeros((2, 3, model.nv))
        for side, of in enumerate((leg, platform)):
            mujoco.mj_jac(model, data, linear[side], angular[side], point, of)
        rows += list((linear[0] - linear[1])[:2])
        if model.eq_type[index] == mujoco.mjtEq.mjEQ_WELD:
            rows.append((angular[0] - angular[1])[2])
    return np.array(rows)


def closures_at(model, positions):
    data = mujoco.MjData(model)
    data.qpos[:] = positions
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return closures(model, data)


def forces(path, motion):
    model = mujoco.MjModel.from_xml_path(path)
    model.opt.gravity[:] = motion["gravity"]
    # Bodies without mass in the model have one gram in the file.
    model.body_inertia[model.body_mass == 1e-3] = 1e-12
    model.body_mass[model.body_mass == 1e-3] = 1e-12
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    data = mujoco.MjData(model)
    platform = np.array([model.joint(f"platform_{axis}").dofadr[0] for axis in ("x", "y", "phi")])
    legs = np.setdiff1d(np.arange(model.nv), platform)
    here = closures_at(model, data.qpos)
    follow = np.linalg.pinv(here[:, legs])
    rates = np.zeros(model.nv)
    rates[platform] = motion["twist"]
    rates[legs] = -follow @ (here[:, platform] @ motion["twist"])
    change = (closures_at(model, data.qpos + STEP * rates) - closures_at(model, data.qpos - STEP * rates)) / (2 * STEP)
    accelerations = np.zeros(model.nv)
    accelerations[platform] = motion["acceleration"]
    accelerations[legs] = -follow @ (here[:, platform] @ motion["acceleration"] + change @ rates)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data.qvel[:], data.qacc[:] = rates, accelerations
    mujoco.mj_inverse(model, data)
    needed = data.qfrc_inverse.copy()
    driven = [model.jnt_dofadr[joint] for joint in model.actuator_trnid[:, 0]]
    selection = np.zeros((model.nv, len(driven)))
    selection[driven, range(len(driven))] = 1.0
    columns = np.hstack([selection, here.T])
    found = np.linalg.lstsq(columns, needed, rcond=None)[0]
    return {
        "pose": data.qpos[[model.joint(f"platform_{axis}").qposadr[0] for axis in ("x", "y", "phi")]].tolist(),
        "forces": found[: len(driven)].tolist(),
        "speeds": rates[driven].tolist(),
        "off": float(np.abs(columns @ found - needed).max() / np.abs(needed).max()),
    }


def main():
    motion_path, *models = sys.argv[1:]
    with open(motion_path, encoding="utf-8") as file:
        motion = json.load(file)
    print(json.dumps([forces(model, motion) for model in models]))


if __name__ == "__main__":
    main()
