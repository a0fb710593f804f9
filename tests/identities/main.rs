//! Identities that hold for every mechanism, on random trees with every kind of joint.

mod batch;
mod dynamics;
mod random;
