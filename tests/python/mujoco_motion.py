"""Moves a design's MJCF in MuJoCo along its reference trajectory, and reports how far the platform deviates from the path and how well the
keyframes close the loops.

Usage: mujoco_motion.py DESIGN.xml TRAJECTORY.csv
"""

import csv
import json
import sys

import mujoco
import numpy as np


def gap(model, data):
    """Returns the largest distance between the points that a closure connects."""
    mujoco.mj_forward(model, data)
    rows = [row for row in range(data.nefc) if data.efc_type[row] == mujoco.mjtConstraint.mjCNSTR_EQUALITY]
    return max(abs(float(data.efc_pos[row])) for row in rows)


def main():
    model_path, trajectory_path = sys.argv[1:]
    model = mujoco.MjModel.from_xml_path(model_path)
    with open(trajectory_path, encoding="utf-8") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    places = [model.joint(f"platform_{axis}").qposadr[0] for axis in ("x", "y", "phi")]
    driven = [model.jnt_dofadr[joint] for joint in model.actuator_trnid[:, 0]]

    def column(name):
        return np.array([[row[f"{name}{leg}"] for leg in (1, 2, 3)] for row in rows])

    times = np.array([row["t_s"] for row in rows])
    positions, rates, forces = column("q"), column("qd"), column("tau")
    path = np.array([[row["x_m"], row["y_m"], np.radians(row["phi_deg"])] for row in rows])

    open_by = off = 0.0
    rests = [key for key in range(model.nkey) if model.key(key).name.startswith("rest_")]
    for key in rests:
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, key)
        open_by = max(open_by, gap(model, data))
        there = path[np.argmin(abs(times - model.key(key).time[0]))]
        off = max(off, float(np.hypot(*(data.qpos[places] - there)[:2])))

    # A control counts from the exported pose. The values of an actuator at the beginning are those of the keyframe, up to whole turns.
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, rests[0])
    data.time = 0.0
    positions = positions - model.actuator_biasprm[:, 0] / model.actuator_gainprm[:, 0]
    positions = positions + np.round((data.ctrl - positions[0]) / (2 * np.pi)) * 2 * np.pi * (model.jnt_type[model.actuator_trnid[:, 0]] == 3)
    stiffness, damping = model.actuator_gainprm[:, 0], -model.actuator_biasprm[:, 2]
    farthest = turned = 0.0
    next_row = 0
    steps = model.opt.timestep * np.arange(1, int(round(times[-1] / model.opt.timestep)) + 1)
    value, rate, force = (
        np.stack([np.interp(steps, times, of[:, leg]) for leg in range(3)], axis=1) for of in (positions, rates, forces)
    )
    # The servos damp the whole speed, so a controller adds what the trajectory needs to its reference.
    for control in value + (damping * rate + force) / stiffness:
        data.ctrl[:] = control
        mujoco.mj_step(model, data)
        while next_row < len(times) and times[next_row] <= data.time + 1e-9:
            away = data.qpos[places] - path[next_row]
            farthest = max(farthest, float(np.hypot(*away[:2])))
            turned = max(turned, abs(float(away[2])))
            next_row += 1
    print(
        json.dumps(
            {
                "rows": len(rows),
                "rests": len(rests),
                "open_m": open_by,
                "off_rest_m": off,
                "farthest_m": farthest,
                "turned_rad": turned,
                "travelled_m": float(np.hypot(*(path - path[0]).T[:2]).max()),
                "driven": len(driven),
                "warnings": int(sum(warning.number for warning in data.warning)),
            }
        )
    )


if __name__ == "__main__":
    main()
