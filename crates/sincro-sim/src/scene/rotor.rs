//! From a rotor of the file to its law.

use sincro_dynamics::force::rotor::{ConstantCoefficients, Drag, Rotor, RotorLaw, RotorSpec as Blades, Spin};
use sincro_dynamics::model::{RotorDrive, RotorSpec};

use super::Spec;
use super::file::{RotorFile, SpinFile};
use super::signal_file::SignalReader;
use crate::problem::Problem;

/// The rotor with its speed; a rotor that cannot be becomes a frame, and the reason is noted.
pub(super) fn spec(file: &RotorFile, pointer: &str, density: f64, signals: &mut SignalReader<'_>) -> Spec {
    let speed = signals.read(&file.speed, &format!("{pointer}/speed"));
    let spin = match file.spin {
        SpinFile::Ccw => Spin::CounterClockwise,
        SpinFile::Cw => Spin::Clockwise,
    };
    let law = match (&file.blade, &file.constant) {
        (Some(blade), _) => {
            let blades = Blades {
                radius: blade.radius,
                chord: blade.chord,
                n_blades: blade.n_blades,
                lift_slope: blade.lift_slope,
                collective_pitch: blade.collective_pitch,
                drag: Drag { cd0: blade.cd0, k_cd: blade.k_cd },
                spin,
            };
            match Rotor::new(blades) {
                Ok(rotor) => RotorLaw::Blade(rotor),
                Err(reasons) => {
                    for reason in reasons {
                        let at = signals.document.title_at(pointer);
                        signals.problems.push(Problem::error(&at, format!("rotor `{}`: {reason}", file.name)));
                    }
                    return Spec::Frame;
                }
            }
        }
        (None, Some(constant)) => {
            RotorLaw::Constant(ConstantCoefficients { thrust: constant.thrust, torque: constant.torque, spin })
        }
        (None, None) => return Spec::Frame,
    };
    Spec::Rotor(RotorSpec { law, density, drive: RotorDrive::Command }, speed)
}
