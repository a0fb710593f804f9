"""The run under way, the equations of motion, linear analysis, exceptions."""

import json
import subprocess
import sys

import numpy as np
import pytest

import sincro

CART = "scenes/cart-pole-lqr"
RAIL, HINGE = "/rail.position", "/rail/cart/hinge.position"


def cart(**experiment):
    return sincro.load(CART, **experiment)


def test_signals_have_unit_time_and_error_bar():
    result = cart().run()
    signal = result[HINGE]
    assert isinstance(signal, np.ndarray) and signal.unit == "rad" and signal.name == HINGE
    assert signal.time.shape == signal.shape and signal.time[1] == 0.02
    assert 0 < signal.error_bar < 1e-6
    assert not signal.flags.writeable
    assert type(signal * 2) is np.ndarray and isinstance(signal.max(), float)
    assert result.verdict == "holds" and result.audit["ok"] and result.status == "completed"
    assert all(check["verdict"] == "holds" for check in result.checks)


def test_the_same_run_twice_has_the_same_hash_and_settings_change_it():
    hashes = [cart().run(error_bars=False, until=0.5).trace_hash for _ in range(2)]
    assert hashes[0] == hashes[1]
    other = sincro.load(CART, {"/rail/cart/hinge/pole.mass": 0.2}).run(error_bars=False, until=0.5)
    assert other.trace_hash != hashes[0]


def test_snapshot_goes_back_bit_for_bit():
    model = cart()
    model.step(steps=50)
    moment = model.snapshot()
    model.step(steps=50)
    later, hash_later = model.state, model.trace_hash
    model.restore(moment)
    assert model.time == 1.0
    model.step(steps=50)
    assert model.trace_hash == hash_later and np.array_equal(model.q, later.q)
    other = model.copy()
    other.restore(moment)
    other.step(steps=50)
    assert other.trace_hash == hash_later


def test_held_commands_win_and_are_released():
    model = cart()
    model.step({"/rail": 3.0}, steps=3)
    assert model["/rail.command"] == 3.0
    model.step([-2.0])
    assert model["/rail.command"] == -2.0
    model.release()
    model.step()
    assert model["/rail.command"] not in (3.0, -2.0)


def test_equations_of_motion_agree_with_each_other():
    model = sincro.load("scenes/double-pendulum")
    generator = np.random.default_rng(1)
    for _ in range(20):
        q, v, tau = generator.normal(size=(3, model.n_v))
        v_dot = model.forward_dynamics(q, v, tau)
        np.testing.assert_allclose(model.inverse_dynamics(q, v, v_dot), tau, atol=1e-10)
        mass = model.mass_matrix(q)
        np.testing.assert_allclose(mass, mass.T, atol=1e-14)
        bias = model.inverse_dynamics(q, v, np.zeros_like(v))
        np.testing.assert_allclose(mass @ v_dot + bias, tau, atol=1e-10)
        by_q, by_v, by_tau = model.forward_dynamics_derivatives(q, v, tau)
        np.testing.assert_allclose(by_tau, np.linalg.inv(mass), atol=1e-9)
        for k, step in enumerate(1e-6 * np.eye(model.n_v)):
            difference = (model.forward_dynamics(q + step, v, tau) - model.forward_dynamics(q - step, v, tau)) / 2e-6
            np.testing.assert_allclose(by_q[:, k], difference, rtol=1e-5, atol=1e-6)
            difference = (model.forward_dynamics(q, v + step, tau) - model.forward_dynamics(q, v - step, tau)) / 2e-6
            np.testing.assert_allclose(by_v[:, k], difference, rtol=1e-5, atol=1e-6)


def test_jacobian_maps_velocities():
    model = sincro.load("scenes/double-pendulum")
    body = model.frames[-1]
    model.set_state(q=[0.3, -0.4], v=[1.0, 2.0])
    velocity = model.observe([f"{body}.velocity.{axis}" for axis in "xyz"])
    np.testing.assert_allclose((model.jacobian(body) @ model.v)[3:], velocity, atol=1e-12)


def test_states_that_are_none_are_refused_and_quaternions_scaled(tmp_path):
    model = sincro.load(scene(tmp_path))
    with pytest.raises(ValueError, match="beyond its limit 2"):
        model.set_state(q=[0, 0, 1, 1, 0, 0, 0, 5])
    with pytest.raises(ValueError, match="no rotation"):
        model.set_state(q=[0, 0, 1, 0, 0, 0, 0, 0])
    model.set_state(q=[0, 0, 1, 2, 0, 0, 0, 2])
    np.testing.assert_array_equal(model.q, [0, 0, 1, 1, 0, 0, 0, 2])
    zero = np.zeros(model.n_v)
    one, two = (model.forward_dynamics([0, 0, 1, *q, 0.3], zero, zero) for q in ([0.8, 0.6, 0, 0], [1.6, 1.2, 0, 0]))
    np.testing.assert_array_equal(one, two)


def scene(folder):
    (folder / "scene.toml").write_text(
        """format = 2
[[joint]]
name = "f"
kind = "free"
[[body]]
name = "b"
parent = "/f"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
[[joint]]
name = "h"
parent = "/f/b"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
limits = { lower = -1.0, upper = 2.0 }
[[body]]
name = "arm"
parent = "/f/b/h"
mass = 1.0
center_of_mass = [0.2, 0.0, 0.0]
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
"""
    )
    (folder / "experiment.toml").write_text('format = 2\ntitle = "t"\nduration = 1.0\nstep = 0.01\nrecord = ["energy.total"]\n')
    return folder


def test_linearize_trim_and_lqr():
    model = sincro.load(CART, {"/rail/cart/hinge.initial.position": 0.0})
    system = model.linearize(at=0.0)
    A, B, C, D = system
    assert system.states[:2] == [RAIL, HINGE] and A.shape == (4, 4) and B.shape == (4, 1)
    gain = system.lqr([1, 10, 1, 1], [0.1])
    np.testing.assert_allclose(gain, [[-3.16227766016838, -49.5382717484982, -5.91443631723358, -12.846078506305167]])
    assert np.all(np.linalg.eigvals(A - B @ gain).real < 0)
    assert C.shape[1] == 4 and D.shape[1] == 1
    rest = model.trim()
    assert rest.largest_rate < 1e-9


def test_margins_are_those_of_the_command_line():
    scene, signal = "scenes/two-dof-position", "speed[0]"
    command = [sys.executable, "-m", "sincro", "linearize", scene, "--sampled", "--loop", signal, "--json"]
    told = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    system = sincro.load(scene).linearize(at=0.0, sampled=True, loops=[signal])
    assert system.report == told and system.sample_time == 0.005
    (loop,) = system.loops.values()
    # an integrator sampled with gain: |L| = k·h/|z − 1| is 1 a little above k = 2 rad/s, a quarter turn from −1
    assert loop.phase_margin.omega == pytest.approx(2.0, rel=1e-3)
    assert loop.phase_margin.value == pytest.approx(90.0, abs=1.0) and loop.gain_margin is None
    assert loop.omega.shape == loop.magnitude_db.shape == loop.phase_deg.shape
    assert loop.modulus_margin.value < 1.0 and system.loops[signal].samples_per_period == 1
    fresh = sincro.load(scene).linearize(sampled=True, loops=[signal])
    assert fresh.loops[signal].phase_margin == loop.phase_margin


def test_margins_of_a_channel():
    # a motor that has its commanded speed at once is an integrator
    system = sincro.load("scenes/motor-step").linearize(at=0.0)
    margin = system.margins().phase_margin
    assert margin.omega == pytest.approx(1.0) and margin.value == pytest.approx(90.0)
    assert system.margins("/motor.command", "/motor.position").modulus_margin is None
    with pytest.raises(sincro.UnknownNameError, match="no input"):
        system.margins("/nothing", system.outputs[0])
    with pytest.raises(sincro.ArgumentError, match="sampled=True"):
        sincro.load("scenes/spring-dynamic").linearize(loops=["x"])
    with pytest.raises(sincro.ArgumentError, match="as a whole"):
        sincro.load("scenes/spring-dynamic").linearize(sampled=True, outputs=["/shoulder.position"])
    with pytest.raises(sincro.SceneError, match="no signal `speed`"):
        sincro.load("scenes/two-dof-position").linearize(at=0.0, sampled=True, loops=["speed"])


def test_a_function_controls_in_lock_step_as_the_diagram_does():
    reference = cart(duration=2.0).run(error_bars=False, variants=False)
    model = cart(duration=2.0, step=0.001, record_every=20)
    gain = np.array([-3.16227766016838, -49.5382717484982, -5.91443631723358, -12.846078506305167])
    times = []

    @model.controller(
        period=0.001,
        reads=[RAIL, HINGE, "/rail.velocity", "/rail/cart/hinge.velocity"],
        writes=["/rail"],
    )
    def feedback(t, y):
        times.append(t)
        return [float(np.clip(-gain @ y, -8, 8))]

    result = model.run()
    assert times[:3] == [0.0, 0.001, 0.002]
    difference = np.abs(np.asarray(result[HINGE]) - np.asarray(reference[HINGE])).max()
    # the diagram is continuous, the function holds its command for 1 ms
    assert 1e-6 < difference < 1e-3
    assert result[HINGE].error_bar is None, "a function with a memory is run once"
    model.step(steps=10)
    assert model.time == pytest.approx(0.01)
    model.clear_controllers()
    assert model.controllers == []


def test_an_object_with_reset_is_run_again_for_the_error_bars():
    class Counter:
        def __init__(self):
            self.resets = 0

        def reset(self):
            self.resets += 1

        def __call__(self, t, y):
            return {"/rail": 0.0}

    model, counter = cart(), Counter()
    model.controller(counter, period=0.1)
    result = model.run(until=1.0, variants=False)
    assert counter.resets == 2 and result[HINGE].error_bar is not None


def test_an_exception_in_a_controller_keeps_what_was_recorded():
    model = cart()

    @model.controller(period=0.1)
    def divide(t, y):
        return [1.0 / (0.5 - t)] if abs(t - 0.5) > 1e-9 else [1 / 0]

    with pytest.raises(sincro.ControllerError, match="ZeroDivisionError") as caught:
        model.run()
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    assert caught.value.time == pytest.approx(0.5) and caught.value.result.time[-1] == pytest.approx(0.5)
    with pytest.raises(sincro.ControllerError):
        model.step(steps=100)


@pytest.mark.parametrize("answer", [[1.0, 2.0], [float("nan")], "text", {"/rial": 1.0}, [None], object()])
def test_wrong_answers_of_controllers_are_refused(answer):
    model = cart()
    model.controller(lambda t, y: answer, name="wrong")
    with pytest.raises(sincro.ControllerError):
        model.step()


def test_a_controller_cannot_step_its_own_model():
    model = cart()
    model.controller(lambda t, y: model.step(), name="greedy")
    with pytest.raises(sincro.ControllerError, match="in the middle of a step"):
        model.step()


def test_problems_have_place_and_help():
    with pytest.raises(sincro.SceneError, match="there is no object") as caught:
        sincro.load(CART, {"/rail/crat.mass": 1})
    (problem,) = caught.value.diagnostics
    assert problem["severity"] == "error" and "did you mean" in problem["help"]
    with pytest.raises(sincro.SceneError, match="no-such-scene"):
        sincro.load("scenes/no-such-scene")
    with pytest.raises(sincro.UnknownNameError, match="did you mean `/rail.position`"):
        cart()["/rail.positon"]
    with pytest.raises(KeyError):
        cart().run(until=0.1, error_bars=False)["/rail.positon"]
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, sincro.SincroError)


@pytest.mark.parametrize(
    "u", [[1.0, 2.0], [], [np.nan], [np.inf], "text", [[1.0]], [1 + 2j], {"/rail": [1, 2]}, {"/nothing": 1.0}, object()]
)
def test_wrong_inputs_are_refused(u):
    model = cart()
    with pytest.raises(sincro.SincroError):
        model.step(u)
    assert model.tick == 0


def test_a_closed_model_says_so():
    with cart() as model:
        model.step()
    for use in (model.step, model.run, model.snapshot, lambda: model.q, lambda: model.mass_matrix([0, 0])):
        with pytest.raises(sincro.ClosedError):
            use()


def test_a_run_that_stops_says_why():
    model = sincro.load(CART, {"/rail/cart/hinge.spring.stiffness": 1e8, "integrator": "rk4"})
    result = model.run(error_bars=False)
    assert result.status == "stopped" and result.report["status"]["help"]
    with pytest.raises(sincro.StoppedError, match="help") as caught:
        model.step(steps=10_000)
    assert caught.value.tick >= 0 and caught.value.help


def test_results_are_written_and_shown(tmp_path):
    result = cart().run(until=0.4)
    page = result.write(tmp_path / "out")
    assert page.is_file() and (page.parent / "signals.csv").is_file() and (page.parent / "run.json").is_file()
    assert "<iframe" in result._repr_html_() and "<svg" in result.html()
    assert set(result.to_dict()) == set(result)


def test_a_scene_in_code_is_that_of_its_files(tmp_path):
    scene = sincro.Scene("Pendulum", duration=1.0, step=0.005)
    hinge = scene.add("joint", "hinge", kind="revolute", axis=[0, 1, 0], initial={"position": 1.0})
    scene.add("body", "bob", parent=hinge, position=[0, 0, -0.5], density=1000.0, shape=[{"sphere": {"radius": 0.05}}])
    scene.record(hinge + ".position")
    in_code = sincro.load(scene).run()
    in_files = sincro.load(scene.write(tmp_path / "pendulum")).run()
    assert in_code.trace_hash == in_files.trace_hash and in_code.status == "completed"


def test_variants_are_results():
    result = sincro.load("scenes/motor-step").run(error_bars=False)
    for name, variant in result.variants.items():
        assert variant.time.size > 1 and variant.trace_hash and name in repr(variant)
    with pytest.raises(sincro.UnknownNameError):
        result._run.columns("no such variant")


URDF = """<robot name="r"><link name="base"/><link name="a"><inertial><origin xyz="0 0 -0.5"/><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 1 0"/></joint></robot>"""


def test_robots_are_imported(tmp_path):
    robot = tmp_path / "r.urdf"
    robot.write_text(URDF)
    assert sincro.load(robot).n_v == 1
    imported = sincro.import_robot(robot, tmp_path / "scene", motors="torque")
    assert imported.report["counts"]["dropped"] == 0
    model = sincro.load(imported.folder)
    model.step([1.0])
    assert model.v[0] > 0
    with pytest.raises(sincro.SceneError, match="is not empty"):
        sincro.import_robot(robot, tmp_path / "scene")
    robot.write_text("<robot>")
    with pytest.raises(sincro.SceneError) as caught:
        sincro.load(robot)
    assert caught.value.diagnostics[0]["line"] == 1


def test_a_fixed_body_is_moved_and_takes_along_what_a_bushing_joins_to_it(tmp_path):
    (tmp_path / "scene.toml").write_text(
        """gravity = [0.0, 0.0, 0.0]
frame = [{ name = "target", position = [0.0, 0.0, 1.0] }]
body = [{ name = "hand", parent = "/free", mass = 2.0, inertia = { xx = 0.1, yy = 0.1, zz = 0.1 } }]
joint = [{ name = "free", kind = "free", initial = { position = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0] } }]
bushing = [{ name = "grasp", between = ["/target", "/free/hand"], stiffness = 200.0, damping = 40.0, rotational_stiffness = 20.0, rotational_damping = 4.0 }]
"""
    )
    (tmp_path / "experiment.toml").write_text('title = "mocap"\nduration = 5.0\nstep = 0.01\nrecord = ["/free/hand.position.x"]\n')
    model = sincro.load(tmp_path)
    model.step(steps=50)
    assert abs(model["/free/hand.position.x"]) < 1e-12
    turned = [np.cos(0.2), 0.0, 0.0, np.sin(0.2)]
    model.set_pose("/target", position=[0.3, 0.0, 1.0], quaternion_wxyz=turned)
    # critically damped: x = 0.3 (1 − (1 + ω t) exp(−ω t)), ω = 10 rad/s
    model.step(steps=20)
    np.testing.assert_allclose(model["/free/hand.position.x"], 0.3 * (1 - 3 * np.exp(-2.0)), rtol=1e-5)
    model.step(steps=200)
    np.testing.assert_allclose(model.observe(["/free/hand.position.x", "/grasp.rotation.z"]), [0.3, 0.0], atol=1e-5)
    with pytest.raises(sincro.ArgumentError, match="moves with joints"):
        model.set_pose("/free/hand", position=[0.0, 0.0, 0.0])
    with pytest.raises(sincro.ArgumentError, match="no object"):
        model.set_pose("/nowhere", position=[0.0, 0.0, 0.0])


def test_a_model_with_python_functions_refuses_to_move_what_is_fixed_and_goes_on(tmp_path):
    (tmp_path / "scene.toml").write_text(
        """frame = [{ name = "target", position = [0.0, 0.0, 1.0] }]
joint = [{ name = "hinge", kind = "revolute", axis = [0.0, 1.0, 0.0], motor = { mode = "torque" } }]
body = [{ name = "arm", parent = "/hinge", mass = 2.0, inertia = { xx = 0.1, yy = 0.1, zz = 0.1 } }]
"""
    )
    (tmp_path / "experiment.toml").write_text('title = "functions"\nduration = 5.0\nstep = 0.01\nrecord = ["/hinge.position"]\n')
    model, other = sincro.load(tmp_path), sincro.load(tmp_path)
    for each in (model, other):
        each.controller(lambda t, y: [0.5], name="push", period=0.1, writes=["/hinge"])
        each.step(steps=5)
    with pytest.raises(sincro.ArgumentError, match="Python functions do not follow"):
        model.set_pose("/target", position=[0.3, 0.0, 1.0])
    for each in (model, other):
        each.step(steps=5)
    assert model.tick == 10 and model.trace_hash == other.trace_hash
