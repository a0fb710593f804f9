//! A run as an MCAP file for Foxglove, Lichtblick or Rerun: transforms and shapes under Foxglove's schemas, signals as JSON.
//!
//! | topic | schema | what |
//! |---|---|---|
//! | `/tf` | `foxglove.FrameTransforms` | frames of the objects in the world, at the replay's rate |
//! | `/scene` | `foxglove.SceneUpdate` | shapes of the bodies, once |
//! | `/arrows` | `foxglove.SceneUpdate` | contact, external, drag and thrust forces and the wind, at the replay's rate |
//! | `/PATH`, `/energy` … | `sincro.Signals` of that object | recorded signals, every row |
//!
//! Times are simulated ones, in nanoseconds from zero. Names of signals become fields: `/air.position.x` is `position_x` of the topic `/air`.

mod arrows;
mod entity;

use std::collections::BTreeMap;
use std::io::{self, BufWriter};
use std::path::Path;

use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions, Writer};
use serde_json::{Map, Value, json};
use sincro_sim::replay::{ObjectView, SceneView, Tape};
use sincro_sim::results::FileError;
use sincro_sim::run::Done;
use sincro_sim::table::Table;

type Out = Writer<BufWriter<std::fs::File>>;

/// Writes the main run of a campaign.
///
/// # Errors
///
/// The file cannot be written.
pub fn write(done: &Done, path: &Path) -> Result<(), FileError> {
    let failed = |e: io::Error| FileError::new("write", path, e);
    let file = std::fs::File::create(path).map_err(failed)?;
    let options = WriteOptions::new().compression(None).library("sincro");
    let write = || -> Result<(), McapError> {
        let mut out = options.create(BufWriter::new(file))?;
        entity::shapes(&mut out, &done.view)?;
        if let Some(tape) = &done.simulated.tape {
            transforms(&mut out, &done.view, tape)?;
            arrows::write(&mut out, &done.view, tape)?;
        }
        signals(&mut out, &done.simulated.table)?;
        out.finish()?;
        Ok(())
    };
    write().map_err(|e| failed(io::Error::other(e)))
}

fn channel(out: &mut Out, topic: &str, schema: &str, fields: &Value) -> Result<u16, McapError> {
    let schema = out.add_schema(schema, "jsonschema", fields.to_string().as_bytes())?;
    out.add_channel(schema, topic, "json", &BTreeMap::new())
}

fn send(out: &mut Out, channel_id: u16, sequence: usize, t: f64, message: &Value) -> Result<(), McapError> {
    let time = nanoseconds(t);
    let header = MessageHeader {
        channel_id,
        sequence: u32::try_from(sequence).unwrap_or(u32::MAX),
        log_time: time,
        publish_time: time,
    };
    out.write_to_known_channel(&header, message.to_string().as_bytes())
}

fn nanoseconds(t: f64) -> u64 {
    (t * 1e9).round() as u64
}

/// Seconds and nanoseconds.
fn stamp(t: f64) -> Value {
    let ns = nanoseconds(t);
    json!({ "sec": ns / 1_000_000_000, "nsec": ns % 1_000_000_000 })
}

/// A JSON schema of an object with these fields.
fn object(fields: &[(&str, Value)]) -> Value {
    let properties: Map<String, Value> =
        fields.iter().map(|(name, schema)| ((*name).to_owned(), schema.clone())).collect();
    json!({ "type": "object", "properties": properties })
}

fn number() -> Value {
    json!({ "type": "number" })
}

fn text() -> Value {
    json!({ "type": "string" })
}

fn time() -> Value {
    object(&[("sec", json!({ "type": "integer" })), ("nsec", json!({ "type": "integer" }))])
}

fn vector() -> Value {
    object(&[("x", number()), ("y", number()), ("z", number())])
}

fn quaternion() -> Value {
    object(&[("x", number()), ("y", number()), ("z", number()), ("w", number())])
}

fn list(of: &Value) -> Value {
    json!({ "type": "array", "items": of })
}

fn transforms(out: &mut Out, view: &SceneView, tape: &Tape) -> Result<(), McapError> {
    let one = object(&[
        ("timestamp", time()),
        ("parent_frame_id", text()),
        ("child_frame_id", text()),
        ("translation", vector()),
        ("rotation", quaternion()),
    ]);
    let id = channel(out, "/tf", "foxglove.FrameTransforms", &object(&[("transforms", list(&one))]))?;
    for k in 0..tape.n_frames() {
        let (t, frame) = (tape.times[k], tape.frame(k));
        let mut all: Vec<Value> = (0..view.n_movers)
            .map(|m| {
                let at: Vec<f64> = frame[7 * m..7 * m + 7].iter().map(|x| f64::from(*x)).collect();
                transform(t, "world", &mover_name(m), &at)
            })
            .collect();
        if k == 0 {
            all.extend(view.objects.iter().map(|o| transform(t, &carrier(o), &o.path, &o.pose)));
        }
        send(out, id, k, t, &json!({ "transforms": all }))?;
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
    let clean = field.trim_end_matches(']').chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    (topic, clean.collect())
}

fn signals(out: &mut Out, table: &Table) -> Result<(), McapError> {
    let mut topics: BTreeMap<String, Vec<(String, usize)>> = BTreeMap::new();
    for (k, column) in table.columns.iter().enumerate().skip(1) {
        let (topic, field) = place_of(&column.name);
        topics.entry(topic).or_default().push((field, k));
    }
    for (topic, fields) in topics {
        let described = |(field, k): &(String, usize)| {
            let column = &table.columns[*k];
            (field.clone(), json!({ "type": "number", "description": format!("{} [{}]", column.name, column.unit) }))
        };
        let properties: Map<String, Value> = fields.iter().map(described).collect();
        let schema = json!({ "title": format!("sincro.Signals{topic}"), "type": "object", "properties": properties });
        let id = channel(out, &topic, &format!("sincro.Signals{topic}"), &schema)?;
        for (row, t) in table.times().iter().enumerate() {
            let values = fields.iter().map(|(field, k)| (field.clone(), json!(table.columns[*k].values[row])));
            send(out, id, row, *t, &Value::Object(values.collect()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::sync::atomic::AtomicBool;

    use sincro_sim::load;
    use sincro_sim::run::run_campaign;

    use super::*;

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
        let loaded = load(&folder, &[]).unwrap();
        let campaign = run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
        let path: PathBuf = std::env::temp_dir().join(format!("sincro-{}.mcap", std::process::id()));
        write(&campaign.main, &path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let messages: Vec<mcap::Message<'_>> = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
        let of = |topic: &str| messages.iter().filter(|m| m.channel.topic == topic).collect::<Vec<_>>();
        let simulated = &campaign.main.simulated;
        assert_eq!(of("/tf").len(), simulated.tape.as_ref().unwrap().n_frames());
        assert_eq!(of("/scene").len(), 1);
        let shoulder = of("/shoulder");
        assert_eq!(shoulder.len(), simulated.table.n_rows());
        let last: Value = serde_json::from_slice(&shoulder.last().unwrap().data).unwrap();
        let expected = simulated.table.column("/shoulder.position").unwrap().values.last().copied();
        assert_eq!(last["position"].as_f64(), expected);
        assert_eq!(shoulder[0].channel.schema.as_ref().unwrap().encoding, "jsonschema");
    }
}
