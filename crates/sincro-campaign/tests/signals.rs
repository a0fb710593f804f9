//! The long table of signals: every recorded time of every run, whoever makes it.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use sincro_campaign::{Campaign, Plan, Shard, Store, collect, run_shard};
use sincro_sim::formats::parquet::{ParquetFile, Values};
use sincro_sim::{Extensions, load};
use sincro_testing::SceneFolder;

const SCENE: &str = "format = 2\n[[joint]]\nname = \"j\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n\
    spring = { stiffness = 30.0 }\ndamping = 1.0\n\
    [[body]]\nname = \"rod\"\nparent = \"j\"\nmass = 4.0\ncenter_of_mass = [0.25, 0.0, 0.0]\n\
    inertia = { xx = 0.01, yy = 0.1, zz = 0.1 }\n";
const EXPERIMENT: &str = "format = 2\ntitle = \"Rods\"\nduration = 0.1\nstep = 0.01\nrecord = [\"/j.position\"]\n\
    [campaign]\nruns = 6\nrows_per_part = 2\nsignals = [\"/j.velocity\", \"/j.position\"]\nsignals_every = 5\n\
    [[campaign.parameter]]\npath = \"/j.damping\"\nuniform = { from = 0.5, to = 2.0 }\n\
    [[campaign.measure]]\nname = \"last\"\nsignal = \"/j.position\"\nmeasure = \"final\"\n";

static GO: AtomicBool = AtomicBool::new(false);

fn campaign(folder: &SceneFolder) -> Campaign {
    let plan = Plan::open(folder).unwrap();
    Campaign::new(plan, |path, settings| load(path, settings, Extensions::default())).unwrap()
}

#[test]
fn a_campaign_with_a_measure_of_no_signal_does_not_begin() {
    let wrong = EXPERIMENT.replace("name = \"last\"\nsignal = \"/j", "name = \"last\"\nsignal = \"/k");
    assert_ne!(wrong, EXPERIMENT);
    let folder = SceneFolder::of(SCENE, &wrong);
    let plan = Plan::open(&folder).unwrap();
    let found = Campaign::new(plan, |path, settings| load(path, settings, Extensions::default())).unwrap_err();
    assert!(found.to_string().contains("there is no signal `/k.position`"), "{found}");
}

fn make(campaign: &Campaign, out: &Path, n_shards: u64) {
    let store = Store::open(out, campaign, "experiment.toml").unwrap();
    for index in 1..=n_shards {
        let shard = Shard { index, count: n_shards };
        run_shard(campaign, &store, shard, 2, &GO, &mut |_, _| {}).unwrap();
    }
    collect(&store).unwrap();
}

/// Bytes of all files of the table, in their order.
fn bytes(out: &Path) -> Vec<Vec<u8>> {
    let mut files: Vec<_> = std::fs::read_dir(out.join("signals")).unwrap().map(|f| f.unwrap().path()).collect();
    files.sort();
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

#[test]
fn every_recorded_time_of_every_run_is_there_and_shards_write_the_same_bytes() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    let (campaign, results) = (campaign(&folder), SceneFolder::new());
    let [one, three] = ["one", "three"].map(|name| results.join(name));
    make(&campaign, &one, 1);
    make(&campaign, &three, 3);
    assert_eq!(bytes(&one), bytes(&three));
    let mut file = ParquetFile::open(&one.join("signals/signals-000000002-000000003.parquet")).unwrap();
    let names: Vec<&str> = file.columns.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["k", "t", "/j.velocity", "/j.position"]);
    let group = file.group(0).unwrap();
    assert_eq!(group[0], Values::Ints(vec![2, 2, 2, 3, 3, 3]));
    assert_eq!(group[1], Values::Doubles(vec![0.0, 0.05, 0.1, 0.0, 0.05, 0.1]));
    // the last position of a run is its measure
    let row = campaign.run(3, &GO).unwrap().unwrap();
    let Values::Doubles(positions) = &group[3] else { panic!("positions are numbers") };
    assert_eq!(positions[5], row.measures[0]);
}

#[test]
fn a_part_whose_series_are_lost_is_made_again() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    let (campaign, results) = (campaign(&folder), SceneFolder::new());
    let out = results.join("out");
    make(&campaign, &out, 1);
    let whole = bytes(&out);
    std::fs::remove_file(out.join("signals/signals-000000004-000000005.parquet")).unwrap();
    let store = Store::open(&out, &campaign, "experiment.toml").unwrap();
    assert!(collect(&store).unwrap_err().to_string().contains("4"));
    make(&campaign, &out, 1);
    assert_eq!(bytes(&out), whole);
}
