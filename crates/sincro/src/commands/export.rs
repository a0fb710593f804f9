//! `sincro export`: a scene in another format; a file of its own for each kind.

use clap::Subcommand;

use super::export_c;
#[cfg(feature = "adapters")]
use super::export_fmu;
use super::export_robot;
use crate::Exit;

/// Formats.
#[derive(Debug, Subcommand)]
pub(crate) enum Format {
    #[cfg(feature = "adapters")]
    /// A functional mock-up unit for Simulink, Modelica tools and all others that import FMI
    Fmu(export_fmu::Arguments),
    /// C99 without any library: plant, controller and self-test, for microcontrollers and other programs
    C(export_c::Arguments),
    /// Unified Robot Description Format
    Urdf(export_robot::Arguments),
    /// MuJoCo's XML
    Mjcf(export_robot::Arguments),
    /// Simulation Description Format
    Sdf(export_robot::Arguments),
}

/// Runs the command.
pub(crate) fn run(format: &Format) -> Exit {
    use sincro_import::export::Format as Robot;
    match format {
        #[cfg(feature = "adapters")]
        Format::Fmu(arguments) => export_fmu::run(arguments),
        Format::C(arguments) => export_c::run(arguments),
        Format::Urdf(arguments) => export_robot::run(arguments, Robot::Urdf),
        Format::Mjcf(arguments) => export_robot::run(arguments, Robot::Mjcf),
        Format::Sdf(arguments) => export_robot::run(arguments, Robot::Sdf),
    }
}
