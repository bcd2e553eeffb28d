"""What two readers say of exported URDF robots: urdf_parser_py and MuJoCo.

Reads a JSON list of jobs from standard input and writes a JSON list of answers. A job names a file (`robot`), the links at
whose origins it looks (`tips`), the prefix of one leg's joints (`prefix`) and their angles (`tilt_rad`). SI units.
"""

import json
import sys

import mujoco
from urdf_parser_py.urdf import URDF

# Without it MuJoCo makes one body of links that are fixed to each other.
KEEP_LINKS = '<mujoco><compiler fusestatic="false" balanceinertia="false"/></mujoco>'


def answer(job):
    with open(job["robot"], encoding="utf-8") as file:
        text = file.read()
    return {"parser": parsed(URDF.from_xml_string(text)), "mujoco": simulated(job, text)}


def parsed(robot):
    joints = [joint for joint in robot.joints if joint.type == "revolute"]
    return {
        "root": robot.get_root(),
        "links": [link.name for link in robot.links],
        "mass_kg": sum(link.inertial.mass for link in robot.links if link.inertial),
        "inertias": {
            link.name: [link.inertial.inertia.ixx, link.inertial.inertia.iyy, link.inertial.inertia.izz]
            for link in robot.links
            if link.inertial
        },
        "joints": [joint.name for joint in joints],
        "axes": [list(joint.axis) for joint in joints],
        "zeros_rad": [sum(joint.origin.rpy) for joint in joints],
        "limits": [
            [joint.limit.lower, joint.limit.upper, joint.limit.effort, joint.limit.velocity]
            for joint in joints
        ],
        "shapes": [type(visual.geometry).__name__ for link in robot.links for visual in link.visuals],
    }


def simulated(job, text):
    head, mark, rest = text.partition("<link")
    model = mujoco.MjModel.from_xml_string(head + KEEP_LINKS + mark + rest)
    data = mujoco.MjData(model)
    for name, angle in zip(["tilt_x", "tilt_y"], job["tilt_rad"]):
        data.joint(job["prefix"] + name).qpos[0] = angle
    mujoco.mj_forward(model, data)
    return {
        "mass_kg": float(sum(model.body_mass)),
        "tips_m": [data.body(name).xpos.tolist() for name in job["tips"]],
    }


json.dump([answer(job) for job in json.load(sys.stdin)], sys.stdout)
