//! `quadrotor-remote`: command-filtered integral backstepping, from positions, Euler angles and velocities in single
//! precision.

use sincro_coppelia::api::Value;
use sincro_math::elementary::{asin, atan2, exp, sin_cos, tan};

use super::{Stepper, finished, in_process, ints, serve, set_and_step, single, zmq};

const SCENE: &str = "quadrotor-remote";
const STEPS: usize = 1200;
const TS: f64 = 0.05;
const ROTORS: [&str; 4] = ["rotor1", "rotor2", "rotor3", "rotor4"];

type V3 = [f64; 3];

const KP: V3 = [0.69, 0.69, 9.2];
const KD: V3 = [0.8 / 3.0, 0.8 / 3.0, 10.0 / 3.0];
const KI: V3 = [0.036, 0.036, 0.0015];
const GAMMA1: V3 = [16.0, 16.0, 7.2];
const GAMMA2: V3 = [36.0, 36.0, 18.0];
const INERTIA: V3 = [9.5 * 2.643e-3, 9.5 * 2.643e-3, 9.5 * 1.525e-2];

fn each(f: impl FnMut(usize) -> f64) -> V3 {
    std::array::from_fn(f)
}

/// Memory of the controller.
#[derive(Default)]
struct Law {
    reference: [[f64; 2]; 3],
    xi: V3,
    chi2: V3,
    xi1: V3,
    omega_f: V3,
}

impl Law {
    /// From position, α β γ, velocity and angular velocity in the world.
    fn speeds(&mut self, k: usize, p: V3, angles: V3, v: V3, world_rates: V3) -> [f64; 4] {
        let r = rotation(angles);
        let eta = [atan2(r[2][1], r[2][2]).0, asin((-r[2][0]).clamp(-1.0, 1.0)).0, atan2(r[1][0], r[0][0]).0];
        let w = each(|j| (0..3).map(|i| r[i][j] * world_rates[i]).sum());
        let a = self.acceleration(k, p, v);
        let (thrust, eta_c) = extract(a, eta);
        let tau = self.torque(eta_c, eta, w);
        let (b, torque, arm) = (1.9468e-4 / 4.0, 9.841743337582103e-5, 0.5);
        let (mean, roll, pitch, yaw) =
            (thrust / (4.0 * b), tau[0] / (2.0 * b * arm), tau[1] / (2.0 * b * arm), tau[2] / (4.0 * torque));
        let squares = [mean - pitch - yaw, mean + roll + yaw, mean + pitch - yaw, mean - roll + yaw];
        squares.map(|x| (8192.0 * x.clamp(0.0, 1200.0 * 1200.0).sqrt()).round() / 8192.0)
    }

    fn acceleration(&mut self, k: usize, p: V3, v: V3) -> V3 {
        let goal = [
            0.0,
            if k < 400 {
                0.0
            } else if k < 800 {
                0.1
            } else {
                -0.1
            },
            1.0,
        ];
        each(|i| {
            let [y, rate] = self.reference[i];
            let (e, e_p) = (y - goal[i], y - p[i]);
            let a = -e - 2.0 * rate + KD[i] * (rate - v[i]) + KP[i] * e_p + KI[i] * self.xi[i];
            self.xi[i] += TS * e_p;
            let (x, lead) = (exp(-TS).0, rate + e);
            self.reference[i] = [goal[i] + x * (e + TS * lead), x * (rate - TS * lead)];
            a
        })
    }

    fn torque(&mut self, eta_c: V3, eta: V3, w: V3) -> V3 {
        let ((s, c), (sp, cp), t) = (sin_cos(eta[0]), sin_cos(eta[1]), tan(eta[1]).0);
        let z1 = each(|i| eta_c[i] - eta[i]);
        let g = each(|i| GAMMA1[i] * z1[i]);
        let omega_c = [g[0] - sp * g[2], c * g[1] + s * cp * g[2], -s * g[1] + c * cp * g[2]];
        let (before, share) = (self.omega_f, 1.0 - exp(-75.0 * TS).0);
        self.omega_f = each(|i| before[i] + share * (omega_c[i] - before[i]));
        let d = each(|i| self.omega_f[i] - omega_c[i]);
        let lost = [d[0] + t * (s * d[1] + c * d[2]), c * d[1] - s * d[2], (s * d[1] + c * d[2]) / cp];
        self.xi1 = each(|i| self.xi1[i] + TS * (-lost[i] - GAMMA1[i] * self.xi1[i]));
        let v1 = each(|i| z1[i] - self.xi1[i]);
        let turned = [v1[0], s * t * v1[0] + c * v1[1] + s / cp * v1[2], c * t * v1[0] - s * v1[1] + c / cp * v1[2]];
        let z2 = each(|i| self.omega_f[i] - w[i]);
        let demand = each(|i| {
            (self.omega_f[i] - before[i]) / TS + GAMMA2[i] * z2[i] + 0.1 * GAMMA2[i] * self.chi2[i] + turned[i]
        });
        self.chi2 = each(|i| self.chi2[i] + TS * z2[i]);
        let h = each(|i| INERTIA[i] * w[i]);
        let gyroscopic = [w[1] * h[2] - w[2] * h[1], w[2] * h[0] - w[0] * h[2], w[0] * h[1] - w[1] * h[0]];
        each(|i| INERTIA[i] * demand[i] + gyroscopic[i])
    }
}

/// Rx(α)·Ry(β)·Rz(γ)
fn rotation(angles: V3) -> [V3; 3] {
    let [(sa, ca), (sb, cb), (sc, cc)] = angles.map(sin_cos);
    [
        [cb * cc, -cb * sc, sb],
        [ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb],
        [sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb],
    ]
}

/// Thrust, and the attitude that gives an acceleration at the present yaw.
fn extract(a: V3, eta: V3) -> (f64, V3) {
    let (s, c) = sin_cos(eta[2]);
    let (ax, ay) = (a[0] * c + a[1] * s, a[1] * c - a[0] * s);
    let pitch = atan2(ax, 9.81 + a[2]).0;
    let roll = atan2(-ay * sin_cos(pitch).1, 9.81 + a[2]).0;
    let thrust = 10.305 * (9.81 + a[2]) / (sin_cos(eta[0]).1 * sin_cos(eta[1]).1);
    (thrust, [roll.clamp(-0.6, 0.6), pitch.clamp(-0.6, 0.6), 0.0])
}

#[test]
fn a_legacy_client_flies_the_bits_of_the_diagram() {
    let server = serve(SCENE);
    for _ in 0..2 {
        let body = {
            let mut client = super::Legacy::connect(server.ports().legacy[0]);
            client.handle("quadrotor#")
        };
        let (pose, velocity) = (ints(&[body, -1]), ints(&[body]));
        let streams = [(0x200e, pose.clone()), (0x200d, pose), (0x1036, velocity)];
        let mut client = Stepper::start(&server, &ROTORS, &streams);
        let mut law = Law::default();
        for k in 0..STEPS {
            let three = |numbers: &[f64]| [numbers[0], numbers[1], numbers[2]];
            let p = three(&client.read(0x200e, &[body, -1], 3));
            let angles = three(&client.read(0x200d, &[body, -1], 3));
            let rates = client.read(0x1036, &[body], 6);
            client.step(&law.speeds(k, p, angles, three(&rates), three(&rates[3..])));
        }
        client.stop();
        assert_eq!(finished(&server), (in_process(SCENE), STEPS as u64));
    }
}

#[test]
fn a_zeromq_client_flies_the_bits_of_the_diagram() {
    let server = serve(SCENE);
    let mut client = zmq(&server);
    let body = client.object("/quadrotor");
    let rotors = ROTORS.map(|name| client.object(&format!("/{name}")));
    let mut law = Law::default();
    for k in 0..STEPS {
        let mut read = |name: &str| -> Vec<V3> {
            let results = client.call(name, std::slice::from_ref(&body)).unwrap();
            results.iter().map(|v| <V3>::try_from(v.as_reals().unwrap()).unwrap().map(single)).collect()
        };
        let (p, angles) = (read("sim.getObjectPosition")[0], read("sim.getObjectOrientation")[0]);
        let rates = read("sim.getObjectVelocity");
        set_and_step(&mut client, &rotors, &law.speeds(k, p, angles, rates[0], rates[1]));
    }
    let refused = client.call("sim.getJointPosition", &rotors[..1]).unwrap_err();
    assert!(refused.contains("is a rotor: it has a speed"), "{refused}");
    let told = client.real("sim.getJointTargetVelocity", &rotors[..1]);
    let speed = client.real("sim.getJointVelocity", &rotors[..1]);
    assert!((told - speed).abs() < 0.05 && told > 700.0, "told {told}, turns at {speed}");
    assert_eq!(client.call("sim.getObjectType", &rotors[..1]).unwrap(), [Value::Int(1)]);
    client.call("sim.stopSimulation", &[]).unwrap();
    assert_eq!(finished(&server), (in_process(SCENE), STEPS as u64));
}
