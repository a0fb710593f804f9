//! Trajectory of a run: keyframes with the poses of all links, decimated, in single precision.
//!
//! | part of a frame | numbers | unit |
//! |---|---|---|
//! | for each joint: position of its last link, quaternion x, y, z, w | 7 | m, 1 |
//! | for each rotor: speed, thrust, torque | 3 | rad/s, N, N·m |
//! | for each external force: its components in the world | 3 | N |
//! | for each drag element: its force in the world | 3 | N |
//! | in wind, for each joint whose last link feels it: velocity of the air there, world axes | 3 | m/s |
//! | coordinates q | `n_q` | rad, m |
//! | rates v | `n_v` | rad/s, m/s |
//!
//! Points of contact are kept beside the frames ([`Contacts`]): their number varies. A frame has single precision,
//! about seven digits; `signals.csv` has all of them.

use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::Model;
use sincro_dynamics::spatial::Quat;
use sincro_dynamics::world::Observation;

use super::contacts::{CONTACT, Contacts};
use super::frame_map::FrameMap;
use super::runtime::RuntimeLog;
use super::scene::seven;
use sincro_scene::experiment::Experiment;
use sincro_scene::record::probe::{self, View};

/// Frames a simulated second in a long run [1/s].
const RATE: f64 = 60.0;
/// Frames that a short run has all the same, so that it can be watched slowly.
const LEAST_FRAMES: f64 = 300.0;
/// Limit of the numbers of a trajectory: 64 MB.
const MAX_NUMBERS: u64 = 16_000_000;
/// Points of contact that are expected in a frame at most, where there can be that many.
const USUAL_CONTACTS: usize = 8;

/// Layout of a frame of a [`Trajectory`], in this order: for each joint of the model the pose of its last link in the
/// world (position x, y, z `[m]`, quaternion x, y, z, w); for each rotor speed `[rad/s]`, thrust `[N]`, torque `[N·m]`;
/// for each external force and each drag element its components in world axes `[N]`; where there is wind, its velocity
/// at each joint whose last link feels it `[m/s]`; coordinates q; velocities v.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The link that each joint of the model moves last.
    links: Vec<usize>,
    n_rotors: usize,
    n_forces: usize,
    n_drags: usize,
    /// Joints whose last link feels the wind; none if the air stands still.
    wind_links: Vec<usize>,
    n_q: usize,
    n_v: usize,
}

impl Layout {
    /// Creates the layout of the frames of a model, whose numbers of joints, rotors, forces and coordinates it keeps.
    #[must_use]
    pub fn new(model: &Model<f64>) -> Self {
        let last_link = |v_end: usize| {
            let of_joint = |link: &&(usize, usize)| link.1 < v_end;
            let links: Vec<(usize, usize)> = model.links().iter().map(|l| l.first_dof()).enumerate().collect();
            links.iter().filter(of_joint).max_by_key(|link| link.1).map_or(0, |link| link.0)
        };
        let links: Vec<usize> = model.names().joints.iter().map(|j| last_link(j.v_idx + j.n_v)).collect();
        let feels = |link: usize| {
            model.rotors().iter().any(|rotor| rotor.link == link) || model.drags().iter().any(|drag| drag.link == link)
        };
        let is_windy = model.wind().is_some();
        Self {
            wind_links: (0..links.len()).filter(|k| is_windy && feels(links[*k])).collect(),
            links,
            n_rotors: model.rotors().len(),
            n_forces: model.wrenches().len(),
            n_drags: model.drags().len(),
            n_q: model.n_q(),
            n_v: model.n_v(),
        }
    }

    /// Returns the index of the link whose pose a frame has for each joint, the last one that the joint moves, in the
    /// order of the model's joints.
    #[must_use]
    pub fn links(&self) -> &[usize] {
        &self.links
    }

    /// Joints whose last link feels the wind.
    #[must_use]
    pub(crate) fn wind_links(&self) -> &[usize] {
        &self.wind_links
    }

    /// Returns the number of entries of a frame, all parts together.
    #[must_use]
    pub fn width(&self) -> usize {
        let vectors = self.n_rotors + self.n_forces + self.n_drags + self.wind_links.len();
        7 * self.links.len() + 3 * vectors + self.n_q + self.n_v
    }

    /// Returns the coordinates q in a frame of [`Layout::width`] entries: `n_q` numbers `[rad]`, `[m]`.
    ///
    /// # Panics
    ///
    /// If the frame is too short.
    #[must_use]
    pub fn coordinates<'a>(&self, frame: &'a [f32]) -> &'a [f32] {
        let end = self.width() - self.n_v;
        &frame[end - self.n_q..end]
    }

    /// Appends the frame of a world whose structure has changed to `out`, as [`Layout::write`] does: what has gone is
    /// NaN.
    pub fn write_mapped(&self, map: &FrameMap, seen: &Observation<'_>, t: f64, out: &mut Vec<f32>) {
        let poses = seen.scratch().link_poses();
        let place = |at: &Attached<f64>| at.link.map_or(at.pose, |link| poses[link].compose(&at.pose));
        for mover in &map.movers {
            out.extend(mover.as_ref().map_or([f32::NAN; 7], |at| seven(&place(at)).map(|x| x as f32)));
        }
        let view = View::observed(seen, t);
        for rotor in &map.rotors {
            let numbers = |k: usize| {
                let (speed, load, _) = probe::rotor(&view, k);
                [speed, load.thrust, load.torque].map(|x| x as f32)
            };
            out.extend(rotor.map_or([f32::NAN; 3], numbers));
        }
        for force in &map.forces {
            let numbers = |k: usize| {
                let wrench = &seen.model().wrenches()[k];
                let r_wl = &poses[wrench.link].rot;
                r_wl.mul_vec(wrench.wrench(t, r_wl, &seen.state.commands).lin).0.map(|x| x as f32)
            };
            out.extend(force.map_or([f32::NAN; 3], numbers));
        }
        for drag in &map.drags {
            out.extend(drag.map_or([f32::NAN; 3], |k| probe::drag(&view, k).0.map(|x| x as f32)));
        }
        for &k in &self.wind_links {
            let velocity = map.movers[k].as_ref().zip(seen.model().wind());
            let velocity = velocity.map_or([f64::NAN; 3], |(at, wind)| wind.at(t).velocity_at(place(at).pos).0);
            out.extend(velocity.map(|x| x as f32));
        }
        let number = |list: &[f64], k: &Option<usize>| k.map_or(f32::NAN, |k| list[k] as f32);
        out.extend(map.q.iter().map(|k| number(&seen.state.q, k)));
        out.extend(map.v.iter().map(|k| number(&seen.state.v, k)));
    }

    /// Appends the frame of the observed world at time `t` `[s]` to `out`: [`Layout::width`] numbers.
    pub fn write(&self, seen: &Observation<'_>, t: f64, out: &mut Vec<f32>) {
        let poses = seen.scratch().link_poses();
        for &link in &self.links {
            let (pose, rot) = (&poses[link], Quat::from_matrix(&poses[link].rot));
            let mut wxyz = [0.0; 4];
            rot.write(&mut wxyz);
            let [w, x, y, z] = wxyz;
            out.extend([pose.pos[0], pose.pos[1], pose.pos[2], x, y, z, w].map(|x| x as f32));
        }
        let view = View::observed(seen, t);
        for k in 0..self.n_rotors {
            let (speed, load, _) = probe::rotor(&view, k);
            out.extend([speed, load.thrust, load.torque].map(|x| x as f32));
        }
        for wrench in seen.model().wrenches() {
            let r_wl = &poses[wrench.link].rot;
            let force = r_wl.mul_vec(wrench.wrench(t, r_wl, &seen.state.commands).lin);
            out.extend(force.0.map(|x| x as f32));
        }
        for k in 0..self.n_drags {
            out.extend(probe::drag(&view, k).0.map(|x| x as f32));
        }
        for &k in &self.wind_links {
            let place = poses[self.links[k]].pos;
            let velocity = seen.model().wind().map_or([0.0; 3], |wind| wind.at(t).velocity_at(place).0);
            out.extend(velocity.map(|x| x as f32));
        }
        out.extend(seen.state.q.iter().chain(&seen.state.v).map(|x| *x as f32));
    }
}

/// Trajectory of a run for its replay: frames with the poses of all links, in single precision, at even distances in
/// time. [`RunOptions::keyframes`](crate::run::RunOptions::keyframes) asks for one.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Layout of the frames.
    pub layout: Layout,
    /// Number of base steps between two frames.
    pub every: u64,
    /// Number of base steps done at each frame, ascending.
    pub ticks: Vec<u64>,
    /// Time of each frame `[s]`, ascending.
    pub times: Vec<f64>,
    /// Frames one after the other, [`Layout::width`] numbers each.
    pub numbers: Vec<f32>,
    /// Contact points of each frame.
    pub contacts: Contacts,
    /// Objects that clients and scripts have made.
    pub runtime: RuntimeLog,
}

impl Trajectory {
    /// Creates an empty trajectory for a run of `model`; the distance of the frames follows from duration and size of
    /// the experiment.
    #[must_use]
    pub fn new(model: &Model<f64>, experiment: &Experiment) -> Self {
        let layout = Layout::new(model);
        let span = (1.0 / RATE).min(experiment.duration / LEAST_FRAMES);
        let every = ((span / experiment.step).ceil() as u64).max(1);
        let touching = CONTACT * model.constraints().n_contacts().min(USUAL_CONTACTS);
        let least = (experiment.n_steps * (layout.width() + touching) as u64).div_ceil(MAX_NUMBERS);
        let every = every.max(least);
        let runtime = RuntimeLog::new(layout.links());
        let (ticks, times, numbers) = (Vec::new(), Vec::new(), Vec::new());
        Self { layout, every, ticks, times, numbers, contacts: Contacts::default(), runtime }
    }

    /// Returns true if a frame is to be recorded after `tick` base steps.
    #[must_use]
    pub fn is_due(&self, tick: u64) -> bool {
        tick.is_multiple_of(self.every)
    }

    /// Appends the frame of the observed world after `tick` base steps, at time `t` `[s]`.
    ///
    /// `map` tells where things are in a run whose structure has changed.
    pub fn record(&mut self, seen: &Observation<'_>, tick: u64, t: f64, map: Option<&FrameMap>) {
        self.ticks.push(tick);
        self.times.push(t);
        match map {
            Some(map) => self.layout.write_mapped(map, seen, t, &mut self.numbers),
            None => self.layout.write(seen, t, &mut self.numbers),
        }
        self.contacts.record(seen, map);
    }

    /// Returns the number of frames so far.
    #[must_use]
    pub fn n_frames(&self) -> usize {
        self.times.len()
    }

    /// Returns frame `k` (from 0): [`Layout::width`] numbers, in the order and units of [`Layout`].
    ///
    /// # Panics
    ///
    /// If there is no such frame.
    #[must_use]
    pub fn frame(&self, k: usize) -> &[f32] {
        let width = self.layout.width();
        &self.numbers[k * width..(k + 1) * width]
    }

    /// Returns the indices of frames at even distances over the run, ascending, for a film: at most `rate` per
    /// simulated second `[1/s]` and `most` in all, the first and the last among them.
    #[must_use]
    pub fn evenly_spaced(&self, rate: f64, most: usize) -> Vec<usize> {
        let (Some(start), Some(end)) = (self.times.first(), self.times.last()) else { return Vec::new() };
        let n = (((end - start) * rate) as usize + 1).min(most.max(1));
        let at = |k: usize| {
            let t = start + (end - start) * k as f64 / (n.max(2) - 1) as f64;
            // half a nanosecond of grace: times are sums
            self.times.partition_point(|known| *known <= t + 5e-10).max(1) - 1
        };
        (0..n).map(at).collect()
    }
}
