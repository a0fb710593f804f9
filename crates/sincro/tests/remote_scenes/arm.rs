//! `alexandros-remote`: adaptive compliant inverse kinematics, from the angles of motors and springs in single
//! precision.

use sincro_math::elementary::sin_cos;

use super::{Legacy, Stepper, finished, in_process, ints, serve, set_and_step, single, zmq};

const SCENE: &str = "alexandros-remote";
const STEPS: usize = 1600;
const TS: f64 = 0.02;
const MOTORS: [&str; 4] = ["motor1", "motor2", "motor3", "motor4"];
const SPRINGS: [&str; 4] = ["spring1", "spring2", "spring3", "spring4"];
const KP: V4 = [30.0, 32.0, 36.0, 22.0];
const KS: V4 = [0.32, 0.256, 0.224, 0.288];
const GAMMA: [f64; 8] = [8000.0, 8000.0, 80.0, 800.0, 800.0, 800.0, 80.0, 800.0];
const AXES: [V3; 4] = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
const LINKS: [V3; 4] = [[0.0, 0.102, 0.0], [0.0, 0.0, -0.125], [0.0, 0.0, -0.125], [0.27, 0.0, 0.0]];
const MASSES: V4 = [0.101, 0.121, 0.11, 0.052];

type V3 = [f64; 3];
type V4 = [f64; 4];

fn each(f: impl FnMut(usize) -> f64) -> V4 {
    std::array::from_fn(f)
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn times(r: &[V3; 3], v: V3) -> V3 {
    r.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The arm with its springs straight: origins and axes of the joints, middles of the links, the tip.
struct Arm {
    origins: [V3; 4],
    axes: [V3; 4],
    middles: [V3; 4],
    tip: V3,
}

impl Arm {
    fn at(q: V4) -> Self {
        let (mut r, mut at) = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]);
        let mut arm = Self { origins: [at; 4], axes: [at; 4], middles: [at; 4], tip: at };
        for i in 0..4 {
            (arm.origins[i], arm.axes[i]) = (at, times(&r, AXES[i]));
            r = turned(&r, AXES[i], q[i]);
            let link = times(&r, LINKS[i]);
            arm.middles[i] = std::array::from_fn(|k| at[k] + 0.5 * link[k]);
            at = std::array::from_fn(|k| at[k] + link[k]);
        }
        arm.tip = at;
        arm
    }

    /// Velocity of a point beyond joint i for a unit rate of that joint.
    fn column(&self, i: usize, point: V3) -> V3 {
        cross(self.axes[i], std::array::from_fn(|k| point[k] - self.origins[i][k]))
    }

    /// Torques that carry its weight [N·m].
    fn gravity(&self) -> V4 {
        each(|i| (i..4).map(|n| MASSES[n] * 9.81 * self.column(i, self.middles[n])[2]).sum())
    }
}

/// The rotation followed by one about a coordinate axis of its own.
fn turned(r: &[V3; 3], axis: V3, angle: f64) -> [V3; 3] {
    let (s, c) = sin_cos(angle);
    let [x, y, z] = axis;
    let own = [
        [c + x * x * (1.0 - c), -z * s, y * s],
        [z * s, c + y * y * (1.0 - c), -x * s],
        [-y * s, x * s, c + z * z * (1.0 - c)],
    ];
    r.map(|row| std::array::from_fn(|j| (0..3).map(|k| row[k] * own[k][j]).sum()))
}

struct Law {
    q_r: V4,
    q_r_before: V4,
    wanted: V4,
    theta: [f64; 8],
}

impl Law {
    fn new() -> Self {
        let theta = [0.0, 0.0, 0.0, 0.0, 1.0 / 3.0, 0.5, 1.0, 1.0 / 1.5];
        Self { q_r: [0.0; 4], q_r_before: [0.0; 4], wanted: [0.0; 4], theta }
    }

    fn speeds(&mut self, k: usize, gamma: V4, delta: V4) -> V4 {
        let q = each(|i| gamma[i] + delta[i]);
        let g = Arm::at(q).gravity();
        for i in 0..4 {
            // Φ = [I, −diag(g)]: Φ·Γ·Φᵀ is diagonal
            let x = (q[i] - self.q_r_before[i]) / (1.0 + GAMMA[i] + GAMMA[4 + i] * g[i] * g[i]);
            self.theta[i] += 0.5 * TS * (GAMMA[i] * x);
            self.theta[4 + i] += 0.5 * TS * (-GAMMA[4 + i] * g[i] * x);
        }
        let size: f64 = self.theta.iter().map(|x| x * x).sum();
        assert!(size < 6.0, "the projection onto the ellipsoid is not needed here: {size}");
        let wanted = each(|i| self.q_r[i] - (self.theta[i] - g[i] * self.theta[4 + i]));
        let u = each(|i| (wanted[i] - self.wanted[i]) / TS + KS[i] / TS * (self.wanted[i] - gamma[i]));
        (self.wanted, self.q_r_before) = (wanted, self.q_r);
        let goal = if k < 200 {
            [0.27, 0.102, -0.25]
        } else if k < 900 {
            [0.24, 0.152, -0.2]
        } else {
            [0.31, 0.052, -0.22]
        };
        let arm = Arm::at(self.q_r);
        let miss: V3 = std::array::from_fn(|r| goal[r] - arm.tip[r]);
        let rate = |i: usize| (0..3).map(|r| arm.column(i, arm.tip)[r] * miss[r]).sum::<f64>();
        self.q_r = each(|i| self.q_r[i] + TS * (KP[i] * rate(i)).clamp(-5.0, 5.0));
        u.map(|x| (x.clamp(-5.0, 5.0) * 65536.0).round() / 65536.0)
    }
}

#[test]
fn a_legacy_client_moves_the_arm_by_the_bits_of_the_diagram() {
    let server = serve(SCENE);
    let handles: Vec<i32> = {
        let mut client = Legacy::connect(server.ports().legacy[0]);
        MOTORS.iter().chain(&SPRINGS).map(|name| client.handle(&format!("{name}#"))).collect()
    };
    let streams: Vec<(i32, Vec<u8>)> = handles.iter().map(|h| (0x1001, ints(&[*h]))).collect();
    let mut client = Stepper::start(&server, &MOTORS, &streams);
    let mut law = Law::new();
    for k in 0..STEPS {
        let angle = |i: usize| client.read(0x1001, &[handles[i]], 1)[0];
        let (gamma, delta) = (each(angle), each(|i| angle(4 + i)));
        client.step(&law.speeds(k, gamma, delta));
    }
    client.stop();
    assert_eq!(finished(&server), (in_process(SCENE), STEPS as u64));
}

#[test]
fn a_zeromq_client_moves_the_arm_by_the_bits_of_the_diagram() {
    let server = serve(SCENE);
    let mut client = zmq(&server);
    let motors = MOTORS.map(|name| client.object(&format!("/{name}")));
    let springs = SPRINGS.map(|name| client.object(&format!("/{name}")));
    let mut law = Law::new();
    for k in 0..STEPS {
        let mut angle = |joint: &_| single(client.real("sim.getJointPosition", std::slice::from_ref(joint)));
        let (gamma, delta) = (each(|i| angle(&motors[i])), each(|i| angle(&springs[i])));
        set_and_step(&mut client, &motors, &law.speeds(k, gamma, delta));
    }
    client.call("sim.stopSimulation", &[]).unwrap();
    assert_eq!(finished(&server), (in_process(SCENE), STEPS as u64));
}
