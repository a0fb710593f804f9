//! `sincro export`: a scene in another format; a file of its own for each kind.

use clap::Subcommand;

#[cfg(feature = "formats")]
use super::export_c;
#[cfg(feature = "adapters")]
use super::export_fmu;
#[cfg(feature = "formats")]
use super::export_robot;
use crate::Exit;

/// Formats.
#[derive(Debug, Subcommand)]
pub(crate) enum Format {
    #[cfg(feature = "adapters")]
    /// A functional mock-up unit for Simulink, Modelica tools and all others that import FMI
    Fmu(export_fmu::Arguments),
    #[cfg(feature = "formats")]
    /// C99 without any library: plant, controller and self-test, for microcontrollers and other programs
    C(export_c::Arguments),
    #[cfg(feature = "formats")]
    /// Unified Robot Description Format
    Urdf(export_robot::Arguments),
    #[cfg(feature = "formats")]
    /// MuJoCo's XML
    Mjcf(export_robot::Arguments),
    #[cfg(feature = "formats")]
    /// Simulation Description Format
    Sdf(export_robot::Arguments),
}

/// Runs the command.
pub(crate) fn run(format: &Format) -> Exit {
    #[cfg(feature = "formats")]
    use sincro_import::export::Format as Robot;
    match format {
        #[cfg(feature = "adapters")]
        Format::Fmu(arguments) => export_fmu::run(arguments),
        #[cfg(feature = "formats")]
        Format::C(arguments) => export_c::run(arguments),
        #[cfg(feature = "formats")]
        Format::Urdf(arguments) => export_robot::run(arguments, Robot::Urdf),
        #[cfg(feature = "formats")]
        Format::Mjcf(arguments) => export_robot::run(arguments, Robot::Mjcf),
        #[cfg(feature = "formats")]
        Format::Sdf(arguments) => export_robot::run(arguments, Robot::Sdf),
    }
}
