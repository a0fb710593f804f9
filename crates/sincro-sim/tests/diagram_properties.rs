//! No text makes the readers of diagrams panic, and every problem points into its file.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use sincro_blocks::endpoint::Endpoint;
use sincro_blocks::unit::Unit;
use sincro_testing::scenes;

fn config() -> Config {
    Config { cases: 300, rng_seed: RngSeed::Fixed(11), failure_persistence: None, ..Config::default() }
}

/// Pieces that ends of wires, names, units and numbers are made of, and some that they are not.
const PIECES: &str =
    r#"(a|b|ü|world|/shoulder|\.y|\.u1|\.|\[|\]|0|1|:|,|-|->| |[\u{2003}]|9{20}|→|m|rad|/|\^|²|\*|k|\(|inf|-1){0,9}"#;

/// A value of TOML.
const VALUE: &str = r#"(1|-1|0|inf|nan|1e300|true|"k"|"k \+"|"é\("|\[\]|\[1, 2\]|\[\[1, 2\], \[3\]\]|\{ x = "1" \}|"inf"|2020-01-01|99999999)"#;

proptest! {
    #![proptest_config(config())]

    #[test]
    fn no_end_of_a_wire_panics(any in any::<String>(), made in PIECES) {
        for text in [any, made] {
            if let Err(error) = Endpoint::parse_list(&text) {
                prop_assert!(error.span.start <= error.span.end && error.span.start <= text.len() + 1);
            }
        }
    }

    #[test]
    fn no_unit_panics(any in any::<String>(), made in PIECES) {
        let _ = (Unit::parse(&any), Unit::parse(&made));
    }

    #[test]
    fn no_diagram_panics(
        wires in proptest::collection::vec(PIECES, 0..4),
        names in proptest::collection::vec("(a|b|ü|x1|world)", 3),
        kinds in proptest::collection::vec(0..90_usize, 3),
        values in proptest::collection::vec((0..16_usize, VALUE), 8),
    ) {
        let kinds_of = sincro_scene::diagram::reference::kinds();
        let wires: Vec<String> = wires.iter().map(|w| format!("{:?}", w.replace('\u{2003}', "  "))).collect();
        let mut text = format!("wires = [{}, \"a -> b\", \"b -> a\", \"/shoulder.position -> ü\"]\n", wires.join(", ")).replace("[, ", "[");
        for (name, kind) in names.iter().zip(&kinds) {
            let kind = kinds_of[kind % kinds_of.len()];
            text.push_str(&format!("[[block]]\nname = \"{name}\"\ntype = \"{}\"\n", kind.name));
            let mut given = std::collections::BTreeSet::new();
            for (which, value) in &values {
                if let Some(p) = kind.parameters.get(which % kind.parameters.len().max(1))
                    && given.insert(p.name)
                {
                    text.push_str(&format!("{} = {value}\n", p.name));
                }
            }
        }
        let folder = scenes::sprung_arm();
        folder.change("experiment.toml", "scene = \"scene.toml\"", "scene = \"scene.toml\"\ndiagram = \"diagram.toml\"");
        folder.write("diagram.toml", &text);
        // what it says does not matter here
        let _ = folder.load(&[]);
    }
}
