"""What MuJoCo says of exported legs.

Reads a JSON list of jobs from standard input and writes a JSON list of answers. A job names
a model file (`model`) and, for a leg at rest, other payloads for it (`other_payloads_kg`) and whether to let it fall into
place from the vertical (`settle`); for a swing, a force at the tip that ends (`force_n`); for motors, how far each reels in (`controls_m`); for legs around a body, how long
they shall stand (`stands_s`). SI units.
"""

import json
import sys

import mujoco
import numpy as np

STEP_RAD = 1e-6  # of the central differences
CONVERGED_RAD = 1e-11
STEPS_MAX = 50
SETTLED_RAD_PER_S = 1e-8
SETTLE_STEPS_MAX = 200_000
SETTLE_DAMPING = 20.0  # times that of the joints, so that it comes to rest soon
FREE_SPAN_S = 1.0


def answer(job):
    model = mujoco.MjModel.from_xml_path(job["model"])
    if "force_n" in job:
        return free_response(model, job["force_n"])
    if "controls_m" in job:
        return controlled(model, job["controls_m"])
    if "stands_s" in job:
        return standing(model, job["stands_s"])
    model.opt.tolerance = 0.0  # the constraint solver goes on to its rounding
    held = model.key("held").qpos
    found = at_pose(model, held)
    found["tip_at_rest_m"] = tip_at_rest(model, held)
    found["tip_settled_m"] = tip_settled(model) if job["settle"] else None
    payload = model.body("payload")
    found["other_tips_at_rest_m"] = []
    for mass_kg in job["other_payloads_kg"]:
        payload.mass[0] = mass_kg
        found["other_tips_at_rest_m"].append(tip_at_rest(model, held))
    return found


def at_pose(model, position):
    """Tendons and tip without any motion, as the position says."""
    data = mujoco.MjData(model)
    data.qpos[:] = position
    mujoco.mj_forward(model, data)
    rates = np.zeros((model.ntendon, model.nv))
    mujoco.mju_sparse2dense(rates, data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind)
    rotations = np.zeros((3, model.nv))
    mujoco.mj_jacBody(model, data, None, rotations, model.body("leg").id)
    return {
        "lengths_m": data.ten_length[:3].tolist(),
        "length_rates_m_per_rad": rates[:3].tolist(),
        "rotation_rates": rotations.tolist(),
        "tip_m": data.site("tip").xpos.tolist(),
    }


def moment(model, data, position):
    """What would set the resting leg in motion, per joint: weights, springs, tendons and constraints."""
    data.qpos[:] = position
    data.qvel[:] = 0.0
    mujoco.mj_forward(model, data)
    result = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, result, data.qacc)
    return result


def moved(model, position, step):
    result = position.copy()
    mujoco.mj_integratePos(model, result, step, 1.0)
    return result


def tip_at_rest(model, position):
    """The tip where the moment vanishes, by Newton's method."""
    data = mujoco.MjData(model)
    for _ in range(STEPS_MAX):
        slope = np.zeros((model.nv, model.nv))
        for joint, step in enumerate(np.eye(model.nv) * STEP_RAD):
            ahead = moment(model, data, moved(model, position, step))
            behind = moment(model, data, moved(model, position, -step))
            slope[:, joint] = (ahead - behind) / (2.0 * STEP_RAD)
        step = -np.linalg.solve(slope, moment(model, data, position))
        position = moved(model, position, step)
        if np.abs(step).max() < CONVERGED_RAD:
            moment(model, data, position)
            return data.site("tip").xpos.tolist()
    sys.exit(f"Newton's method does not converge: the last step was {step} rad")


def tip_settled(model):
    """The tip after the simulation has come to rest, let go at the vertical."""
    data = mujoco.MjData(model)
    damping = model.dof_damping.copy()
    model.dof_damping[:] *= SETTLE_DAMPING
    for _ in range(SETTLE_STEPS_MAX):
        mujoco.mj_step(model, data)
        if np.abs(data.qvel).max() < SETTLED_RAD_PER_S and np.abs(data.qacc).max() < SETTLED_RAD_PER_S:
            model.dof_damping[:] = damping
            return data.site("tip").xpos.tolist()
    sys.exit(f"the leg does not come to rest within {data.time} s: it still moves at {data.qvel} rad/s")


def free_response(model, force_n):
    """The tip over time after a force there, under which the leg has come to rest, has ended; and what the sensors say at rest."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("held").id)
    mujoco.mj_forward(model, data)
    sensors = data.sensordata.tolist()
    leg = model.body("leg").id
    steps = round(FREE_SPAN_S / model.opt.timestep)
    damping = model.dof_damping.copy()
    model.dof_damping[:] *= SETTLE_DAMPING
    for _ in range(2 * steps):
        data.qfrc_applied[:] = 0.0
        mujoco.mj_applyFT(model, data, np.array(force_n), np.zeros(3), data.site("tip").xpos, leg, data.qfrc_applied)
        mujoco.mj_step(model, data)
    model.dof_damping[:] = damping
    data.qfrc_applied[:] = 0.0
    data.qvel[:] = 0.0
    tips = []
    for _ in range(steps):
        tips.append(data.site("tip").xpos.tolist())
        mujoco.mj_step(model, data)
    return {"sensors": sensors, "step_s": model.opt.timestep, "tips_m": tips}


def controlled(model, controls_m):
    """The tip at rest after motors have reeled in, where they are after each time constant of the first, and the counts at rest."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("held").id)
    data.ctrl[:] = controls_m
    model.dof_damping[:] *= SETTLE_DAMPING
    per_m = model.numeric("counts_per_m").data
    time_s = model.actuator_dynprm[0, 0]
    reeled_m = []
    apart = 0.0
    while data.time < FREE_SPAN_S or np.abs(data.qvel).max() > SETTLED_RAD_PER_S:
        counts = per_m * data.act
        mujoco.mj_step(model, data)
        # What the sensors say is of the begin of the step.
        apart = max(apart, np.abs(counts_by_sensors(model, data) - counts).max())
        if data.time >= (len(reeled_m) + 1) * time_s - 0.5 * model.opt.timestep and len(reeled_m) < 3:
            reeled_m.append(data.act.tolist())
    return {
        "tip_m": data.site("tip").xpos.tolist(),
        "tensions_n": [data.sensor(f"tension_{i}").data[0] for i in (1, 2, 3)],
        "servo_time_s": time_s,
        "reeled_m": reeled_m,
        "counts": counts_by_sensors(model, data).tolist(),
        "counts_apart": apart,
    }


def counts_by_sensors(model, data):
    """The encoders' counts, by the formula of the file's comment."""
    sensor = {name: np.array([data.sensor(f"{name}_{i}").data[0] for i in (1, 2, 3)]) for name in ("length", "rate", "tension")}
    number = lambda name: model.numeric(name).data
    pull_n = sensor["tension"] - number("damping_n_s_per_m") * sensor["rate"]
    return number("counts_per_m") * (number("unstretched_m") - sensor["length"] + pull_n / number("stiffness_n_per_m"))


def standing(model, span_s):
    """How far a body on its legs has sunk and leans after a while."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("held").id)
    height = data.qpos[2]
    while data.time < span_s:
        mujoco.mj_step(model, data)
    up = data.body("body").xmat[8]
    return {"sunk_m": height - data.qpos[2], "leans": 1.0 - up, "actuators": model.nu}


json.dump([answer(job) for job in json.load(sys.stdin)], sys.stdout)
