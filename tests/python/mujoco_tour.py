"""Loads a design's MJCF in MuJoCo, moves its actuators along the tour of the design's JSON, and reports how far the
platform deviates from the poses of the tour; also loads the URDF.

Usage: mujoco_tour.py DESIGN.xml DESIGN.json DESIGN.urdf
"""

import json
import sys

import mujoco
import numpy as np

# Approximate number of poses, steps of the ramp that leads to each, and steps for which it is held until oscillations
# decay.
POSES, RAMP, HOLD = 24, 2000, 10000


def main():
    model_path, design_path, urdf_path = sys.argv[1:]
    with open(design_path, encoding="utf-8") as file:
        design = json.load(file)
    model = mujoco.MjModel.from_xml_path(model_path)
    data = mujoco.MjData(model)
    tour = design["tour"][:: len(design["tour"]) // POSES]
    places = [model.joint(f"platform_{axis}").qposadr[0] for axis in ("x", "y", "phi")]
    start = data.qpos[places].copy()
    # A control counts from the exported pose.
    exported = model.actuator_biasprm[:, 0] / model.actuator_gainprm[:, 0]

    # As it is opened, without a keyframe, it stays where it is.
    for _ in range(HOLD):
        mujoco.mj_step(model, data)
    drift = float(abs(data.qpos[places] - start).max())
    before = np.zeros(model.nu)
    farthest = turned = travelled = 0.0
    for pose in tour:
        target = np.array(pose["actuators"])
        if design["actuator"]["kind"] == "revolute":
            target = before + np.remainder(target - exported - before + np.pi, 2 * np.pi) - np.pi
        else:
            target = target - exported
        for step in range(RAMP + HOLD):
            share = min((step + 1) / RAMP, 1.0)
            data.ctrl[:] = before + (target - before) * share * share * (3.0 - 2.0 * share)
            mujoco.mj_step(model, data)
        before = target
        x, y, phi = data.qpos[places]
        farthest = max(farthest, float(np.hypot(x - pose["x_m"], y - pose["y_m"])))
        turned = max(turned, abs(float(phi) - np.radians(pose["phi_deg"])))
        travelled = max(travelled, float(np.hypot(x - start[0], y - start[1])))
    urdf = mujoco.MjModel.from_xml_path(urdf_path)
    print(
        json.dumps(
            {
                "poses": len(tour),
                "drift": drift,
                "farthest_m": farthest,
                "turned_rad": turned,
                "travelled_m": travelled,
                "start": start.tolist(),
                "mass_kg": float(model.body_mass.sum()),
                "closures": int(model.neq),
                "actuators": int(model.nu),
                "stiffness": model.actuator_gainprm[:, 0].tolist(),
                "warnings": int(sum(warning.number for warning in data.warning)),
                "urdf_joints": int(urdf.njnt),
                "urdf_mass_kg": float(urdf.body_mass.sum()),
            }
        )
    )


if __name__ == "__main__":
    main()
