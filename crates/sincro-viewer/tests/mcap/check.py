"""Reads recordings with the MCAP project's own reader and decodes every message with Google's own library by the descriptor that the file
carries. That descriptor is held against the published definitions of Foxglove's messages: every field with its number, type and label.

    pip install mcap foxglove-schemas-protobuf
    python check.py run.mcap ...
"""

import math
import sys
from collections import Counter

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from mcap.reader import make_reader

PUBLISHED = {"foxglove.FrameTransforms": FrameTransforms, "foxglove.SceneUpdate": SceneUpdate}


def shape(descriptor, known):
    """Every field of a message and of those in it: number, name, type, whether there are several."""
    if descriptor.full_name in known:
        return known
    known[descriptor.full_name] = {
        (f.number, f.name, f.type, f.is_repeated, f.message_type.full_name if f.message_type else None) for f in descriptor.fields
    }
    for field in descriptor.fields:
        if field.message_type:
            shape(field.message_type, known)
    return known


def message_class(schema):
    assert schema.encoding == "protobuf", schema.encoding
    pool = DescriptorPool()
    for file in FileDescriptorSet.FromString(schema.data).file:
        pool.Add(file)
    made = pool.FindMessageTypeByName(schema.name)
    if schema.name in PUBLISHED:
        ours, theirs = shape(made, {}), shape(PUBLISHED[schema.name].DESCRIPTOR, {})
        assert ours == theirs, f"{schema.name} is not as published: {set(ours) ^ set(theirs)}"
    return GetMessageClass(made)


def is_finite(message):
    for field, value in message.ListFields():
        if field.message_type:
            parts = value if field.is_repeated else [value]
            if not all(is_finite(part) for part in parts):
                return False
        elif isinstance(value, float) and not math.isfinite(value):
            return False
    return True


def check(path):
    counts, classes, before = Counter(), {}, {}
    frames, named = {"world"}, set()
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None, f"{path}: no summary"
        for schema, channel, message in reader.iter_messages():
            assert channel.message_encoding == "protobuf", channel.topic
            if schema.id not in classes:
                classes[schema.id] = message_class(schema)
            made = classes[schema.id].FromString(message.data)
            if schema.name == "foxglove.FrameTransforms":
                assert is_finite(made), channel.topic
                frames.update(t.child_frame_id for t in made.transforms)
                for t in made.transforms:
                    q = t.rotation
                    length = math.sqrt(q.x**2 + q.y**2 + q.z**2 + q.w**2)
                    assert abs(length - 1) < 1e-5, f"{t.child_frame_id}: a rotation of length {length}"
                    assert t.timestamp.seconds * 10**9 + t.timestamp.nanos == message.log_time, "times differ"
            elif schema.name == "foxglove.SceneUpdate":
                assert is_finite(made), channel.topic
                named.update(entity.frame_id for entity in made.entities)
                for entity in made.entities:
                    for triangles in entity.triangles:
                        assert max(triangles.indices) < len(triangles.points) and len(triangles.indices) % 3 == 0
            else:
                names = {field.name for field in made.DESCRIPTOR.fields}
                assert set(channel.metadata) == names, f"{channel.topic}: units of {set(channel.metadata) ^ names}"
            assert message.log_time >= before.get(channel.topic, 0), f"{channel.topic}: times go back"
            before[channel.topic] = message.log_time
            counts[channel.topic] += 1
        assert sum(counts.values()) == summary.statistics.message_count
    assert named <= frames, f"frames that nobody places: {sorted(named - frames)}"
    print(f"{path}: {sum(counts.values())} messages in {len(counts)} topics read, as published")


if __name__ == "__main__":
    for recording in sys.argv[1:]:
        check(recording)
