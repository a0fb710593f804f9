"""The hash of `Model.run` is that of the command line, for every scene."""

from pathlib import Path

import pytest

import sincro

ROOT = Path(__file__).resolve().parents[3]
SCENES = sorted(path.name for path in (ROOT / "scenes").iterdir() if (path / "experiment.toml").is_file())
TRACES = dict(line.split() for line in (ROOT / "tests/regressions/traces.txt").read_text().splitlines() if line.strip())


@pytest.mark.parametrize("name", SCENES)
def test_hash_is_that_of_the_command_line(name):
    result = sincro.load(ROOT / "scenes" / name).run(error_bars=False)
    assert result.trace_hash == TRACES[name]
    for variant, of_variant in result.variants.items():
        assert of_variant.trace_hash == TRACES[f"{name}/{variant}"]



@pytest.mark.parametrize("name", SCENES)
def test_stepping_gives_the_same_hash(name):
    step = sincro.load(ROOT / "scenes" / name).dt
    model = sincro.load(ROOT / "scenes" / name, duration=max(1, round(0.2 / step)) * step)
    whole = model.run(error_bars=False, variants=False)
    ticks = round(float(whole.time[-1]) / model.dt)
    if whole.status == "completed":
        model.step(steps=ticks)
        assert model.trace_hash == whole.trace_hash
