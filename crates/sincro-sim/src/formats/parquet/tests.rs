//! Files that are written and read again, and damaged ones.

use super::*;
use crate::file::test_folder;

fn sample() -> (Vec<(String, Values)>, Vec<Vec<Values>>) {
    let group = |from: i64| {
        vec![
            Values::Ints((from..from + 3).collect()),
            Values::Doubles(vec![0.5, f64::NAN, -1e300]),
            Values::Texts(vec!["ok".into(), String::new(), "détente".into()]),
        ]
    };
    let groups = vec![group(0), group(3)];
    let names = ["k", "x", "status"];
    let columns = names.iter().zip(&groups[0]).map(|(name, values)| ((*name).to_owned(), values.emptied())).collect();
    (columns, groups)
}

fn file_of_sample() -> Vec<u8> {
    let (columns, groups) = sample();
    let mut writer = Writer::new(Vec::new(), "runs", columns).unwrap();
    groups.iter().for_each(|group| writer.group(group).unwrap());
    writer.finish(&[("input".into(), "0123".into())]).unwrap()
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let path = test_folder("parquet").join("runs.parquet");
    std::fs::write(&path, file_of_sample()).unwrap();
    let mut file = ParquetFile::open(&path).unwrap();
    let (columns, groups) = sample();
    assert_eq!((&file.columns, file.n_rows, file.n_groups()), (&columns, 6, 2));
    assert_eq!(file.footer("input"), Some("0123"));
    for (k, group) in groups.iter().enumerate() {
        // NaN is unequal to itself
        assert_eq!(format!("{:?}", file.group(k).unwrap()), format!("{group:?}"));
    }
}

#[test]
fn no_damage_makes_the_reader_panic() {
    let path = test_folder("parquet-damage").join("runs.parquet");
    let whole = file_of_sample();
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let mut file = ParquetFile::open(&path)?;
        (0..file.n_groups()).try_for_each(|k| file.group(k).map(drop))
    };
    for n in 0..whole.len() {
        assert!(read(&whole[..n]).is_err(), "cut off after {n} bytes");
    }
    for k in 0..whole.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut damaged = whole.clone();
            damaged[k] ^= flip;
            let _ = read(&damaged);
        }
    }
}
