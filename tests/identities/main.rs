//! Identities that hold for every mechanism, on random trees with every kind of joint.

mod batch;
mod derivatives;
mod dynamics;
mod loops;
mod random;
mod rotors;
mod switching;
