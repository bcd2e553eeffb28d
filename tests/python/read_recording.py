"""What the `mcap` package reads of recordings, by the schemas that stand in them.

Reads a JSON list of jobs from standard input and writes a JSON list of answers. A job names a recording (`recording`) and a
layout for Foxglove (`layout`); or only a recording whose program was killed (`unfinished`).
"""

import json
import re
import sys
from pathlib import Path

from jsonschema import Draft202012Validator
from mcap.reader import make_reader


def answer(job):
    if "unfinished" in job:
        return unfinished(job["unfinished"])
    channels, fields, validators = {}, {}, {}
    with Path(job["recording"]).open("rb") as file:
        reader = make_reader(file)
        metadata = {entry.name: entry.metadata for entry in reader.iter_metadata()}
        for schema, channel, message in reader.iter_messages():
            first_s = message.log_time / 1e9
            found = channels.setdefault(channel.topic, {"count": 0, "encoding": channel.message_encoding, "begin_s": first_s})
            found["count"] += 1
            if channel.message_encoding != "json":
                continue
            if channel.topic not in validators:
                described = json.loads(schema.data)
                Draft202012Validator.check_schema(described)
                validators[channel.topic] = Draft202012Validator(described)
                fields[channel.topic] = described["properties"]
            validators[channel.topic].validate(json.loads(message.data))
    paths = sorted(set(layout_paths(json.loads(Path(job["layout"]).read_text()))))
    return {
        "channels": channels,
        "metadata": metadata["leg"],
        "layout_paths": paths,
        "layout_unknown": [path for path in paths if not known(path, fields)],
    }


def unfinished(path):
    """The times of the reports, as the package reads any file."""
    with Path(path).open("rb") as file:
        messages = make_reader(file).iter_messages(topics=["/leg"], log_time_order=False)
        return [json.loads(message.data)["time_s"] for _, _, message in messages]


def layout_paths(part):
    """Every message path of a layout: `/topic.field` or `/topic.field[0]`."""
    if isinstance(part, dict):
        for key, value in part.items():
            if isinstance(value, str) and re.fullmatch(r"(value|path|timestampPath|topicPath)", key) and value.startswith("/"):
                yield value
            else:
                yield from layout_paths(value)
    elif isinstance(part, list):
        for value in part:
            yield from layout_paths(value)


def known(path, fields):
    parts = re.fullmatch(r"(/\w+)\.(\w+)(?:\[(\d)\])?", path)
    if parts is None:
        return False
    topic, field, index = parts.groups()
    schema = fields.get(topic, {}).get(field)
    if schema is None:
        return False
    if schema["type"] == "array" and "maxItems" in schema:
        return index is not None and int(index) < schema["maxItems"]
    return index is None


json.dump([answer(job) for job in json.load(sys.stdin)], sys.stdout)
