//! Cost of a call of a script beside the world's step: `cargo run --release -p sincro-lua --example actuation_cost`.

use std::path::Path;
use std::time::Instant;

use sincro_dynamics::world::MethodKind;
use sincro_scene::overrides::Override;
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_sim::run::LockStep;

/// Formulas of a controller: thirty operations, no call of the simulation.
const LAW: &str = "function sysCall_init() sum, old = 0, 0 end
function sysCall_actuation()
  local e = 0.3 - old
  sum = sum + 0.01 * e
  local x = 2 * e + 0.5 * sum - 0.1 * (e - old)
  for k = 1, 5 do x = x + 0.001 * k * x end
  old = 0.9 * old + 0.1 * x
end";

/// Microseconds a tick of the propeller's stand, with another text of its script if one is given.
fn cost(code: Option<&str>) -> Result<f64, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/propeller-lua");
    let set = match code {
        Some(code) => vec![Override::new("script.0", &format!("{{ object = \"/rail\", code = '''{code}''' }}"))],
        None => Vec::new(),
    };
    let loaded = load(&folder, &set, Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() })
        .map_err(|problems| problems.to_string())?;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let mut run = LockStep::new(&loaded, MethodKind::SemiImplicitEuler, false);
        run.start().map_err(|halt| format!("{halt:?}"))?;
        const N: u32 = 20_000;
        let clock = Instant::now();
        for _ in 0..N {
            run.advance().map_err(|halt| format!("{halt:?}"))?;
        }
        best = best.min(clock.elapsed().as_secs_f64() / f64::from(N) * 1e6);
    }
    Ok(best)
}

fn main() -> Result<(), String> {
    let nothing = cost(Some("function sysCall_init() end"))?;
    let rows = [
        ("empty actuation", cost(Some("function sysCall_actuation() end"))?),
        ("thirty operations", cost(Some(LAW))?),
        ("one call of the simulation", cost(Some("function sysCall_actuation() sim.getSimulationTime() end"))?),
        ("the thesis's propeller, 9 calls", cost(None)?),
    ];
    println!("a step without actuation: {nothing:.2} µs");
    for (name, whole) in rows {
        println!("{name}: {:.2} µs more", whole - nothing);
    }
    Ok(())
}
