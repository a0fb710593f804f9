//! A run as an MCAP file for Foxglove, Lichtblick or Rerun: transforms, shapes and arrows as Foxglove's messages,
//! signals as messages of their own, all as protocol buffers, which all three decode.
//!
//! | topic | schema | what |
//! |---|---|---|
//! | `/tf` | `foxglove.FrameTransforms` | frames of the objects in the world, at the replay's rate |
//! | `/scene` | `foxglove.SceneUpdate` | shapes of the bodies, once |
//! | `/arrows` | `foxglove.SceneUpdate` | contact, external, drag and thrust forces and the wind, at the replay's rate |
//! | `/PATH`, `/energy` … | `sincro.Signals_PATH` | recorded signals, every row; units in the channel's metadata |
//!
//! Times are simulated ones, in nanoseconds from zero. Names of signals become fields: `/air.position.x` is
//! `position_x` of the topic `/air`.

mod arrows;
mod entity;
mod protobuf;

use std::collections::BTreeMap;
use std::io::{self, BufWriter};
use std::path::Path;

use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions, Writer};
use protobuf::Package;
use serde_json::{Value, json};
use sincro_sim::campaign::CompletedRun;
use sincro_sim::file::FileError;
use sincro_sim::replay::{ObjectView, SceneView, Trajectory};
use sincro_sim::table::Table;

/// Definitions of Foxglove's messages.
const FOXGLOVE: &str = include_str!("foxglove.proto");

/// A recording that is being written.
struct Recording {
    out: Writer<BufWriter<std::fs::File>>,
    foxglove: Package,
}

/// Writes a run as an MCAP file at `path`: geometry, transforms, forces and recorded signals as topics of Foxglove's
/// messages, for Foxglove, Lichtblick or Rerun. A file that is there is replaced.
///
/// # Errors
///
/// The file cannot be created or written; the error has its path.
pub fn write(done: &CompletedRun, path: &Path) -> Result<(), FileError> {
    let failed = |e: io::Error| FileError::new("write", path, e);
    let file = std::fs::File::create(path).map_err(failed)?;
    let options = WriteOptions::new().compression(None).library("sincro");
    let write = || -> Result<(), McapError> {
        let mut out = Recording { out: options.create(BufWriter::new(file))?, foxglove: Package::parse(FOXGLOVE) };
        entity::shapes(&mut out, &done.view)?;
        if let Some(trajectory) = &done.simulated.trajectory {
            transforms(&mut out, &done.view, trajectory)?;
            arrows::write(&mut out, &done.view, trajectory)?;
        }
        signals(&mut out, &done.simulated.table)?;
        out.out.finish()?;
        Ok(())
    };
    write().map_err(|e| failed(io::Error::other(e)))
}

impl Recording {
    /// A topic of a message of Foxglove's.
    fn channel(&mut self, topic: &str, message: &str) -> Result<u16, McapError> {
        let descriptor = self.foxglove.descriptor();
        self.channel_of(topic, &format!("foxglove.{message}"), &descriptor, &BTreeMap::new())
    }

    /// A topic of any message, with what is noted beside it.
    fn channel_of(
        &mut self,
        topic: &str,
        message: &str,
        descriptor: &[u8],
        notes: &BTreeMap<String, String>,
    ) -> Result<u16, McapError> {
        let schema = self.out.add_schema(message, "protobuf", descriptor)?;
        self.out.add_channel(schema, topic, "protobuf", notes)
    }

    /// A message of Foxglove's from an object with its fields.
    fn send(&mut self, channel: u16, (k, t): (usize, f64), name: &str, message: &Value) -> Result<(), McapError> {
        let bytes = self.foxglove.encode(name, message);
        self.send_bytes(channel, (k, t), &bytes)
    }

    fn send_bytes(&mut self, channel_id: u16, (k, t): (usize, f64), message: &[u8]) -> Result<(), McapError> {
        let time = nanoseconds(t);
        let sequence = u32::try_from(k).unwrap_or(u32::MAX);
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.out.write_to_known_channel(&header, message)
    }
}

fn nanoseconds(t: f64) -> u64 {
    (t * 1e9).round() as u64
}

/// Seconds and nanoseconds.
fn stamp(t: f64) -> Value {
    let ns = nanoseconds(t);
    json!({ "sec": ns / 1_000_000_000, "nsec": ns % 1_000_000_000 })
}

fn transforms(out: &mut Recording, view: &SceneView, trajectory: &Trajectory) -> Result<(), McapError> {
    let id = out.channel("/tf", "FrameTransforms")?;
    for k in 0..trajectory.n_frames() {
        let (t, frame) = (trajectory.times[k], trajectory.frame(k));
        let mut all: Vec<Value> = (0..view.n_movers)
            .map(|m| {
                let at: Vec<f64> = frame[7 * m..7 * m + 7].iter().map(|x| f64::from(*x)).collect();
                transform(t, "world", &mover_name(m), &at)
            })
            .collect();
        if k == 0 {
            all.extend(view.objects.iter().map(|o| transform(t, &carrier(o), &o.path, &o.pose)));
        }
        out.send(id, (k, t), "FrameTransforms", &json!({ "transforms": all }))?;
    }
    Ok(())
}

fn mover_name(m: usize) -> String {
    format!("joint{m}")
}

fn carrier(object: &ObjectView) -> String {
    object.mover.map_or_else(|| "world".into(), mover_name)
}

fn transform(t: f64, parent: &str, child: &str, at: &[f64]) -> Value {
    json!({
        "timestamp": stamp(t), "parent_frame_id": parent, "child_frame_id": child,
        "translation": xyz(at), "rotation": xyzw(&at[3..]),
    })
}

fn xyz(at: &[f64]) -> Value {
    json!({ "x": at[0], "y": at[1], "z": at[2] })
}

fn xyzw(at: &[f64]) -> Value {
    json!({ "x": at[0], "y": at[1], "z": at[2], "w": at[3] })
}

/// Topic and field of a signal.
fn place_of(name: &str) -> (String, String) {
    let (object, field) = name.split_once('.').unwrap_or((name.split('[').next().unwrap_or(name), name));
    let topic = if object.starts_with('/') { object.to_owned() } else { format!("/{object}") };
    (topic, letters(field.trim_end_matches(']')))
}

/// A name of letters, digits and `_`, which does not begin with a digit.
fn letters(name: &str) -> String {
    let clean: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if clean.starts_with(|c: char| c.is_ascii_digit()) { format!("_{clean}") } else { clean }
}

fn signals(out: &mut Recording, table: &Table) -> Result<(), McapError> {
    let mut topics: BTreeMap<String, Vec<(String, usize)>> = BTreeMap::new();
    for (k, column) in table.columns.iter().enumerate().skip(1) {
        let (topic, field) = place_of(&column.name);
        let known = topics.entry(topic).or_default();
        // two names may differ in signs alone
        let twins = known.iter().filter(|(other, _)| *other == field).count();
        known.push((if twins > 0 { format!("{field}_{}", twins + 1) } else { field }, k));
    }
    for (topic, fields) in topics {
        let name = format!("Signals{}", letters(&topic));
        let package = Package::of_numbers("sincro", &name, fields.iter().map(|(field, _)| field.clone()));
        let units = fields.iter().map(|(field, k)| (field.clone(), table.columns[*k].unit.clone())).collect();
        let id = out.channel_of(&topic, &format!("sincro.{name}"), &package.descriptor(), &units)?;
        for (row, t) in table.times().iter().enumerate() {
            let values = fields.iter().map(|(_, k)| table.columns[*k].values[row]);
            out.send_bytes(id, (row, *t), &protobuf::numbers(values))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::sync::atomic::AtomicBool;

    use sincro_sim::campaign::run_campaign;
    use sincro_sim::load;

    use super::*;
    use sincro_sim::Extensions;

    #[test]
    fn names_become_topics_and_fields() {
        let of = |name| place_of(name);
        assert_eq!(of("/air.position.x"), ("/air".into(), "position_x".into()));
        assert_eq!(of("energy.balance"), ("/energy".into(), "balance".into()));
        assert_eq!(of("speed[0]"), ("/speed".into(), "speed_0".into()));
        assert_eq!(of("/a/b.motor_torque"), ("/a/b".into(), "motor_torque".into()));
    }

    #[test]
    fn a_reader_finds_every_row_and_frame() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/two-dof-open-loop");
        let loaded = load(&folder, &[], Extensions::default()).unwrap();
        let campaign = run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
        let path: PathBuf = std::env::temp_dir().join(format!("sincro-{}.mcap", std::process::id()));
        write(&campaign.main, &path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let messages: Vec<mcap::Message<'_>> = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
        let of = |topic: &str| messages.iter().filter(|m| m.channel.topic == topic).collect::<Vec<_>>();
        let simulated = &campaign.main.simulated;
        assert_eq!(of("/tf").len(), simulated.trajectory.as_ref().unwrap().n_frames());
        assert_eq!(of("/scene").len(), 1);
        let shoulder = of("/shoulder");
        assert_eq!(shoulder.len(), simulated.table.n_rows());
        // its first field, after the byte that says so
        let data = &shoulder.last().unwrap().data;
        let last = f64::from_le_bytes(data[1..9].try_into().unwrap());
        let expected = simulated.table.column("/shoulder.position").unwrap().values.last().copied();
        assert_eq!((data[0], Some(last)), (1 << 3 | 1, expected));
        let channel = &shoulder[0].channel;
        assert_eq!(channel.schema.as_ref().unwrap().name, "sincro.Signals_shoulder");
        assert_eq!(channel.metadata.get("position").map(String::as_str), Some("rad"));
    }
}
