//! Directional and adjoint derivatives of exported scenes against differences, and states in co-simulation.

use sincro_fmu::archive::{unpack, write_files};
use sincro_fmu::variables::Role;
use sincro_fmu::{Catalogue, ExportRequest, FmiVersion, Instance, Kinds, Outputs, export};
use sincro_math::random::SplitMix64;
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::{SceneFolder, repository_scene};

const BOTH: Kinds = Kinds { co_simulation: true, model_exchange: true };

/// An instance of a scene; the folder holds its resources.
fn instance(loaded: &Loaded, outputs: Outputs) -> (SceneFolder, Instance) {
    let request = ExportRequest {
        loaded,
        overrides: &[],
        name: "scene",
        version: FmiVersion::V3,
        kinds: BOTH,
        outputs,
        libraries: &[],
        documentation: &[],
    };
    let files = unpack(&export(&request).unwrap().bytes).unwrap();
    let folder = SceneFolder::new();
    write_files(&folder, &files).unwrap();
    let xml = String::from_utf8(files[0].1.clone()).unwrap();
    let token = xml.split("instantiationToken=\"").nth(1).unwrap().split('"').next().unwrap();
    let instance = Instance::new(&folder.join("resources"), token, Extensions::default()).unwrap();
    (folder, instance)
}

fn references(catalogue: &Catalogue, pick: impl Fn(&Role) -> bool) -> Vec<u32> {
    catalogue.with_role(|role| pick(role).then_some(())).map(|(vr, ..)| vr).collect()
}

fn unknowns(catalogue: &Catalogue) -> Vec<u32> {
    references(catalogue, |role| matches!(role, Role::Output(_) | Role::Derivative(_)))
}

fn knowns(catalogue: &Catalogue) -> Vec<u32> {
    references(catalogue, |role| matches!(role, Role::State(_) | Role::Input(_)))
}

/// Values of the unknowns at states and inputs.
fn values(of: &mut Instance, unknowns: &[u32], (x, u): (&[f64], &[(u32, f64)])) -> Vec<f64> {
    of.set_continuous_states(x).unwrap();
    u.iter().for_each(|(vr, value)| of.set(*vr, *value).unwrap());
    unknowns.iter().map(|vr| of.get(*vr).unwrap()).collect()
}

/// Largest difference between the derivatives and differences of fourth order, relative to the larger of 1 and the
/// largest derivative of the unknown, over random states of a scene.
fn worst(name: &str, n_draws: usize, outputs: Outputs) -> f64 {
    let loaded = load(&repository_scene(name), &[], Extensions::default()).unwrap();
    let (_folder, mut of) = instance(&loaded, outputs);
    of.start_exchange().unwrap();
    of.update_discrete_states().unwrap();
    let catalogue = of.catalogue().clone();
    let (unknowns, knowns) = (unknowns(&catalogue), knowns(&catalogue));
    let n = catalogue.n_states;
    let mut start = vec![0.0; n];
    of.continuous_states(&mut start).unwrap();
    let inputs: Vec<(u32, f64)> = knowns[..]
        .iter()
        .filter(|vr| matches!(catalogue.variables[**vr as usize].role, Role::Input(_)))
        .map(|vr| (*vr, 0.0))
        .collect();
    let mut random = SplitMix64::new(17);
    let mut draw = || 0.2 * (2.0 * random.unit() - 1.0);
    let mut worst = 0.0_f64;
    for _ in 0..n_draws {
        let x: Vec<f64> = start.iter().map(|x| x + x.abs().max(1.0) * draw()).collect();
        let u: Vec<(u32, f64)> = inputs
            .iter()
            .map(|(vr, _)| {
                let start = catalogue.variables[*vr as usize].start.unwrap();
                (*vr, start + start.abs().max(1.0) * draw())
            })
            .collect();
        values(&mut of, &[], (&x, &u));
        let mut columns = Vec::new();
        for known in &knowns {
            let mut exact = vec![0.0; unknowns.len()];
            of.directional_derivative((&unknowns, &[*known]), &[1.0], &mut exact).unwrap();
            let mut at = |by: f64| {
                let (mut x, mut u) = (x.clone(), u.clone());
                match catalogue.variables[*known as usize].role {
                    Role::State(k) => x[k] += by,
                    _ => u.iter_mut().find(|(vr, _)| vr == known).unwrap().1 += by,
                }
                values(&mut of, &unknowns, (&x, &u))
            };
            let h = 1e-3;
            let [far, near] = [2.0 * h, h].map(|h| (at(h), at(-h)));
            let rough: Vec<f64> = (0..unknowns.len())
                .map(|k| (8.0 * (near.0[k] - near.1[k]) - (far.0[k] - far.1[k])) / (12.0 * h))
                .collect();
            values(&mut of, &[], (&x, &u));
            columns.push((exact, rough));
        }
        for (k, unknown) in unknowns.iter().enumerate() {
            let scale = columns.iter().fold(1.0_f64, |most, (exact, _)| most.max(exact[k].abs()));
            for ((exact, rough), known) in columns.iter().zip(&knowns) {
                let error = (exact[k] - rough[k]).abs() / scale;
                if error > 1e-7 {
                    let name = |vr: u32| &catalogue.variables[vr as usize].name;
                    println!("d {} / d {}: {} {}", name(*unknown), name(*known), exact[k], rough[k]);
                }
                worst = worst.max(error);
            }
        }
    }
    worst
}

/// The scenes hold springs, rotors with inflow, free bodies, sampled and continuous diagrams. Roll and yaw of the rod
/// of `spring-dynamic`, which hangs, jump where it is vertical: its recorded signals alone are compared.
#[test]
fn derivatives_are_those_of_differences() {
    let scenes = [
        ("acrobot", 5, Outputs::All),
        ("cart-pole-lqr", 5, Outputs::All),
        ("double-pendulum", 5, Outputs::All),
        ("flexible-equations", 3, Outputs::All),
        ("free-body", 5, Outputs::All),
        ("quadrotor-hover", 2, Outputs::All),
        ("reacher-springs", 5, Outputs::All),
        ("spring-dynamic", 5, Outputs::Recorded),
        ("two-dof-equations", 3, Outputs::All),
    ];
    for (scene, n_draws, outputs) in scenes {
        let worst = worst(scene, n_draws, outputs);
        println!("{scene}: {worst:e}");
        assert!(worst < 1e-7, "{scene}: {worst}");
    }
}

#[test]
fn the_adjoint_is_the_transposed_matrix() {
    let loaded = load(&repository_scene("quadrotor-hover"), &[], Extensions::default()).unwrap();
    let (_folder, mut of) = instance(&loaded, Outputs::All);
    of.start_exchange().unwrap();
    let catalogue = of.catalogue().clone();
    let (unknowns, knowns) = (unknowns(&catalogue), knowns(&catalogue));
    let seed: Vec<f64> = (0..unknowns.len()).map(|k| f64::from(u32::try_from(k).unwrap() % 7) - 3.0).collect();
    let mut adjoint = vec![0.0; knowns.len()];
    of.adjoint_derivative((&unknowns, &knowns), &seed, &mut adjoint).unwrap();
    let mut column = vec![0.0; unknowns.len()];
    for (known, adjoint) in knowns.iter().zip(&adjoint) {
        of.directional_derivative((&unknowns, &[*known]), &[1.0], &mut column).unwrap();
        let sum: f64 = column.iter().zip(&seed).map(|(x, s)| x * s).sum();
        assert!((sum - adjoint).abs() <= 1e-12 * sum.abs().max(1.0), "{sum} {adjoint}");
    }
    // along a direction, the matrix times the direction
    let direction: Vec<f64> = (0..knowns.len()).map(|k| 0.5 - f64::from(u32::try_from(k).unwrap() % 3)).collect();
    let mut along = vec![0.0; unknowns.len()];
    of.directional_derivative((&unknowns, &knowns), &direction, &mut along).unwrap();
    let by_seed: f64 = along.iter().zip(&seed).map(|(x, s)| x * s).sum();
    let by_direction: f64 = adjoint.iter().zip(&direction).map(|(x, d)| x * d).sum();
    assert!((by_seed - by_direction).abs() <= 1e-9 * by_seed.abs().max(1.0), "{by_seed} {by_direction}");
    // what is neither is refused by name
    assert!(
        of.directional_derivative((&knowns[..1], &knowns[..1]), &[1.0], &mut [0.0])
            .unwrap_err()
            .contains("neither an output")
    );
    assert!(of.directional_derivative((&[0], &knowns[..1]), &[1.0], &mut [0.0]).unwrap_err().contains("neither"));
    assert!(of.adjoint_derivative((&unknowns[..1], &[u32::MAX]), &[1.0], &mut [0.0]).is_err());
}

#[test]
fn in_co_simulation_states_and_derivatives_are_those_of_the_communication_point() {
    let loaded = load(&repository_scene("reacher-springs"), &[], Extensions::default()).unwrap();
    let (_folder, mut steps) = instance(&loaded, Outputs::All);
    let (_folder2, mut equations) = instance(&loaded, Outputs::All);
    steps.begin().unwrap();
    equations.start_exchange().unwrap();
    equations.update_discrete_states().unwrap();
    let catalogue = steps.catalogue().clone();
    let (unknowns, knowns) = (unknowns(&catalogue), knowns(&catalogue));
    let states = references(&catalogue, |role| matches!(role, Role::State(_)));
    let input = references(&catalogue, |role| matches!(role, Role::Input(_)))[0];
    let outputs = references(&catalogue, |role| matches!(role, Role::Output(_)));
    for instance in [&mut steps, &mut equations] {
        instance.set(input, 0.01).unwrap();
    }
    for k in 0..40 {
        let n = steps.steps_to(steps.time(), steps.step_size()).unwrap();
        assert_eq!(n, 1, "looking at the states does not move the time");
        steps.advance().unwrap();
        if k % 10 != 9 {
            continue;
        }
        let row: Vec<f64> = outputs.iter().map(|vr| steps.get(*vr).unwrap()).collect();
        let x: Vec<f64> = states.iter().map(|vr| steps.get(*vr).unwrap()).collect();
        assert_ne!(x[0], 0.0);
        equations.set_time(steps.time()).unwrap();
        equations.set_continuous_states(&x).unwrap();
        let (mut ours, mut theirs) = (vec![0.0; unknowns.len()], vec![0.0; unknowns.len()]);
        for known in &knowns {
            steps.directional_derivative((&unknowns, &[*known]), &[1.0], &mut ours).unwrap();
            equations.directional_derivative((&unknowns, &[*known]), &[1.0], &mut theirs).unwrap();
            assert_eq!(ours, theirs);
        }
        let again: Vec<f64> = outputs.iter().map(|vr| steps.get(*vr).unwrap()).collect();
        assert_eq!(row, again, "outputs stay those of the lock-step");
    }
}

#[test]
fn signals_that_no_derivative_needs_are_up_to_date_in_model_exchange() {
    let scene = "
        joint = [{ name = \"slide\", kind = \"prismatic\", axis = [1, 0, 0], initial = { velocity = 2.0 } }]
        [[body]]
        name = \"cart\"
        parent = \"/slide\"
        mass = 1.0
        inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
    ";
    let diagram = "
        wires = [\"/slide.position -> double\"]
        block = [{ name = \"double\", type = \"gain\", gain = 2.0 }]
    ";
    let experiment = "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"double\"]\n";
    let folder = SceneFolder::of(scene, experiment).with("diagram.toml", diagram);
    let (_folder, mut of) = instance(&load(&folder, &[], Extensions::default()).unwrap(), Outputs::All);
    of.start_exchange().unwrap();
    of.update_discrete_states().unwrap();
    let output = references(of.catalogue(), |role| matches!(role, Role::Output(0)))[0];
    assert_eq!(of.catalogue().variables[output as usize].name, "double");
    of.set_time(0.005).unwrap();
    of.set_continuous_states(&[0.7, 2.0]).unwrap();
    assert_eq!(of.get(output).unwrap(), 1.4);
    let mut rates = [0.0; 2];
    of.derivatives(&mut rates).unwrap();
    assert_eq!(rates, [2.0, 0.0]);
}
