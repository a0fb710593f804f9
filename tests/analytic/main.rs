//! Integrators, drives and force elements against closed forms and orders of convergence.

mod activations;
mod air;
mod bushings;
mod contacts;
mod dc_motors;
mod drives;
mod elastic_gears;
mod gravity_field;
mod load_friction;
mod loop_kinds;
mod loops;
mod mechanisms;
mod orders;
mod polynomial_gears;
mod power;
mod reactions;
mod rotors;
mod sensors;
mod spherical_motors;
mod spring_dampers;
mod springs;
mod torus;
mod wind;
