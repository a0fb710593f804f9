//! Plans as functions of `k`, and plans that are refused.

use super::*;

fn plan(text: &str) -> Plan {
    Plan::parse(Path::new("plan.toml"), text.to_owned()).unwrap()
}

fn problems(text: &str) -> Vec<String> {
    let found = Plan::parse(Path::new("plan.toml"), text.to_owned()).unwrap_err();
    found.0.into_iter().map(|problem| problem.message).collect()
}

const DRAWN: &str = "scene = \"x\"\nruns = 100\nseed = 4\n\
    [[parameter]]\npath = \"/a.mass\"\nuniform = { from = 1.0, to = 3.0 }\n\
    [[parameter]]\npath = \"/b.mass\"\nnormal = { mean = 0.0, std = 2.0 }\n";

#[test]
fn a_latin_hypercube_has_one_draw_in_each_interval() {
    let plan = plan(DRAWN);
    let mut seen = [false; 100];
    for k in 0..100 {
        let u = (plan.point(k).values[0] - 1.0) / 2.0;
        seen[(100.0 * u) as usize] = true;
    }
    assert!(seen.iter().all(|seen| *seen));
}

#[test]
fn a_grid_is_complete_and_has_the_same_draws_at_each_point() {
    let text = format!("{DRAWN}[[parameter]]\npath = \"/c.mass\"\nvalues = [1.0, 2.0, 4.0]\n");
    let plan = plan(&text.replace("runs = 100", "runs = 5"));
    assert_eq!((plan.n_grid(), plan.n_runs()), (3, 15));
    for i in 0..5 {
        let points: Vec<RunPoint> = (0..3).map(|g| plan.point(g * 5 + i)).collect();
        assert!(points.iter().all(|p| p.values[..2] == points[0].values[..2]));
        assert_eq!(points.iter().map(|p| p.values[2]).collect::<Vec<_>>(), [1.0, 2.0, 4.0]);
    }
}

#[test]
fn correlated_draws_have_the_correlation_that_was_asked_for() {
    let text = format!("{DRAWN}[[correlation]]\nbetween = [\"/a.mass\", \"/b.mass\"]\nvalue = 0.8\n");
    let plan = plan(
        &text
            .replace("runs = 100", "runs = 4000")
            .replace("uniform = { from = 1.0, to = 3.0 }", "normal = { mean = 5.0, std = 0.1 }"),
    );
    let (mut xy, mut xx, mut yy) = (0.0, 0.0, 0.0);
    for k in 0..4000 {
        let values = plan.point(k).values;
        let (x, y) = ((values[0] - 5.0) / 0.1, values[1] / 2.0);
        (xy, xx, yy) = (xy + x * y, xx + x * x, yy + y * y);
    }
    assert!((xy / (xx * yy).sqrt() - 0.8).abs() < 0.02);
}

#[test]
fn saltelli_blocks_differ_from_their_first_point_in_one_parameter() {
    let plan = plan(&DRAWN.replace("runs = 100", "runs = 8\ndesign = \"saltelli\""));
    for block in 0..2 {
        let of = |which: u64| plan.point(4 * block + which).values;
        assert!(of(2)[0] == of(1)[0] && of(2)[1] == of(0)[1]);
        assert!(of(3)[0] == of(0)[0] && of(3)[1] == of(1)[1]);
        assert!(of(0)[0] != of(1)[0] && of(0)[1] != of(1)[1]);
    }
}

#[test]
fn everything_wrong_is_said_at_once() {
    let found = problems(
        "scene = \"x\"\ndesign = \"lhs\"\nconfidence = 2.0\n\
         [[parameter]]\npath = \"/a.mass\"\nuniform = { from = 3.0, to = 1.0 }\n\
         [[parameter]]\npath = \"/b.mass\"\n\
         [[measure]]\nname = \"m\"\nsignal = \"s\"\nmeasure = \"largest\"\n",
    );
    for part in ["no design `lhs`", "probability", "`/a.mass` mean nothing", "`/b.mass` has 0", "no measure `largest`"]
    {
        assert!(found.iter().any(|message| message.contains(part)), "{part}: {found:?}");
    }
    let found = problems("scene = \"x\"\nrun = 3\n");
    assert!(found[0].contains("unknown field `run`"), "{found:?}");
    assert!(problems(&DRAWN.replace("runs = 100\n", ""))[0].contains("`runs` is missing"));
}

#[test]
fn what_is_there_twice_or_too_large_is_refused() {
    let grid = |path: &str| {
        format!("[[parameter]]\npath = \"{path}\"\nrange = {{ from = 0.0, to = 1.0, points = 1000000 }}\n")
    };
    let paths = ["/c.mass", "/d.mass", "/e.mass", "/f.mass"];
    let found = problems(&format!("{DRAWN}{}", paths.map(grid).concat()));
    assert!(found.iter().any(|message| message.contains("more than a campaign has")), "{found:?}");
    let found = problems(
        "scene = \"x\"\nvariants = [\"main\", \"main\"]\nrows_per_part = 0\n\
         [[parameter]]\npath = \"/a.mass\"\nvalues = [1.0]\n\
         [[parameter]]\nname = \"b\"\npath = \"/a.mass\"\nvalues = [1.0]\n",
    );
    for part in ["`main` is named twice", "`rows_per_part` is 0", "`/a.mass` is set by two"] {
        assert!(found.iter().any(|message| message.contains(part)), "{part}: {found:?}");
    }
}

#[test]
fn settings_are_written_as_toml() {
    let plan = plan("scene = \"x\"\n[set]\na = \"tab\\t, \\u0001\"\nb = [1.0, inf]\nc = 2\n");
    for set in &plan.set {
        let value: toml::Table = format!("x = {}", set.value.value).parse().unwrap();
        assert!(value.contains_key("x"), "{}", set.value.value);
    }
}

#[test]
fn a_correlation_with_columns_of_one_table_is_refused() {
    let folder = std::env::temp_dir().join(format!("sincro-plan-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("t.csv"), "time,p,q\n0,1,2\n1,3,4\n").unwrap();
    let column =
        |c: &str| format!("[[parameter]]\npath = \"/{c}.x\"\ntable = {{ file = \"t.csv\", column = \"{c}\" }}\n");
    let with = "[[correlation]]\nbetween = [\"/a.mass\", \"/p.x\"]\nvalue = 0.5\n";
    let read = |text: String| Plan::parse(&folder.join("plan.toml"), text);
    assert!(read(format!("{DRAWN}{}{with}", column("p"))).is_ok());
    let found = read(format!("{DRAWN}{}{}{with}", column("p"), column("q"))).unwrap_err();
    assert!(found.0[0].message.contains("`/p.x` is drawn with other columns"), "{:?}", found.0[0].message);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_campaign_of_an_experiment_is_a_plan_of_its_own_folder() {
    let path = Path::new("arm/experiment.toml");
    let table = DRAWN.replace("scene = \"x\"\n", "").replace("[[parameter]]", "[[campaign.parameter]]");
    let text = format!("title = \"x\"\nduration = 1.0\n[campaign]\n{table}");
    let found = Plan::parse(path, text.clone()).unwrap();
    let own = plan(DRAWN);
    assert_eq!(found.scene, Path::new("arm"));
    assert_eq!((found.n_runs(), found.point(7).values), (own.n_runs(), own.point(7).values));
    let problem = |text: String| Plan::parse(path, text).unwrap_err().0.remove(0).message;
    assert_eq!(problem("title = \"x\"\n".into()), "the experiment has no campaign");
    assert_eq!(
        problem(text.replace("[campaign]", "[campaign]\nscene = \"y\"")),
        "the campaign of an experiment names a scene"
    );
    assert!(problem(text.replace("runs = 100", "rums = 100")).contains("unknown field `rums`"));
    assert_eq!(problems("runs = 3\n"), ["the plan names no scene"]);
}
