//! The functions as an importer calls them, also as one that makes mistakes.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_void};
use std::path::PathBuf;
use std::ptr::{null, null_mut};

use sincro_fmu::archive::{unpack, write_files};
use sincro_fmu::{Catalogue, ExportRequest, FmiVersion, Kinds, Outputs, export};
use sincro_sim::{Loaded, load};
use sincro_testing::{SceneFolder, repository_scene, run, with_scripts};

use crate::fmi2::*;
use crate::fmi3::*;
use crate::log::Status;

const CS: Kinds = Kinds { co_simulation: true, model_exchange: false };
const BOTH: Kinds = Kinds { co_simulation: true, model_exchange: true };

thread_local! {
    static MESSAGES: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

unsafe extern "C" fn logger3(_: *mut c_void, _: Status, _: *const c_char, message: *const c_char) {
    // SAFETY: a text of the library under test
    let text = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
    MESSAGES.with(|messages| messages.borrow_mut().push(text));
}

fn last_message() -> String {
    MESSAGES.with(|messages| messages.borrow().last().cloned().unwrap_or_default())
}

/// An exported scene whose resources stand in a temporary folder.
struct Fmu {
    _folder: SceneFolder,
    resources: PathBuf,
    token: String,
    catalogue: Catalogue,
    loaded: Loaded,
}

impl Fmu {
    fn of(loaded: Loaded, kinds: Kinds) -> Self {
        let request = ExportRequest {
            loaded: &loaded,
            overrides: &[],
            name: "scene",
            version: FmiVersion::V3,
            kinds,
            outputs: Outputs::Recorded,
            libraries: &[],
            documentation: &[],
        };
        let exported = export(&request).unwrap();
        let files = unpack(&exported.bytes).unwrap();
        let folder = SceneFolder::new();
        write_files(&folder, &files).unwrap();
        let xml = String::from_utf8(files[0].1.clone()).unwrap();
        let token = xml.split("instantiationToken=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        let resources = folder.join("resources");
        Self { _folder: folder, resources, token, catalogue: exported.catalogue, loaded }
    }

    fn scene(name: &str, kinds: Kinds) -> Self {
        Self::of(load(&repository_scene(name), &[], with_scripts()).unwrap(), kinds)
    }

    fn reference(&self, name: &str) -> u32 {
        let found = self.catalogue.variables.iter().position(|variable| variable.name == name);
        u32::try_from(found.unwrap_or_else(|| panic!("there is no variable {name}"))).unwrap()
    }

    fn instantiate(&self, token: &str) -> *mut c_void {
        let texts = [CString::new("test").unwrap(), CString::new(token).unwrap()];
        let path = CString::new(self.resources.to_str().unwrap()).unwrap();
        // SAFETY: texts that live until the call returns
        unsafe {
            fmi3InstantiateCoSimulation(
                texts[0].as_ptr(),
                texts[1].as_ptr(),
                path.as_ptr(),
                false,
                false,
                false,
                true,
                null(),
                0,
                null_mut(),
                Some(logger3),
                None,
            )
        }
    }

    /// An instance in step mode, with parameters and inputs set before.
    fn started(&self, settings: &[(&str, f64)]) -> *mut c_void {
        let c = self.instantiate(&self.token);
        assert!(!c.is_null(), "{}", last_message());
        for (name, value) in settings {
            assert_eq!(set(c, self.reference(name), *value), Status::Ok, "{}", last_message());
        }
        assert_eq!(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), Status::Ok);
        assert_eq!(fmi3ExitInitializationMode(c), Status::Ok, "{}", last_message());
        c
    }
}

fn set(c: *mut c_void, reference: u32, value: f64) -> Status {
    // SAFETY: one reference and one value
    unsafe { fmi3SetFloat64(c, &raw const reference, 1, &raw const value, 1) }
}

fn get(c: *mut c_void, reference: u32) -> f64 {
    let mut value = f64::NAN;
    // SAFETY: one reference and one value
    let status = unsafe { fmi3GetFloat64(c, &raw const reference, 1, &raw mut value, 1) };
    assert_eq!(status, Status::Ok, "{}", last_message());
    value
}

/// Makes a step; returns status, termination, early return, last time.
fn step(c: *mut c_void, t: f64, h: f64) -> (Status, bool, bool, f64) {
    let (mut event, mut terminate, mut early, mut last) = (false, false, false, 0.0);
    // SAFETY: places for the four results
    let status =
        unsafe { fmi3DoStep(c, t, h, true, &raw mut event, &raw mut terminate, &raw mut early, &raw mut last) };
    (status, terminate, early, last)
}

#[test]
fn parameters_and_inputs_act_as_settings_do() {
    let scene = "
        gravity = [0, 0, -9.81]
        joint = [{ name = \"hinge\", kind = \"revolute\", axis = [0, 1, 0], motor = { mode = \"torque\", command = 0.5 } }]
        [[body]]
        name = \"bob\"
        parent = \"/hinge\"
        mass = 2.0
        center_of_mass = [0, 0, -1]
        inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
    ";
    let experiment = "title = \"t\"\nduration = 1.0\nstep = 0.01\nrecord = [\"/hinge.position\", \"/hinge.command\"]\n";
    let folder = SceneFolder::of(scene, experiment);
    let loaded = load(&folder, &[], with_scripts()).unwrap();
    let fmu = Fmu::of(loaded, CS);
    let position = fmu.reference("hinge.position");
    let c = fmu.started(&[("hinge.bob.mass", 3.0), ("hinge.command", 0.25)]);
    for k in 0..100 {
        assert_eq!(step(c, f64::from(k) * 0.01, 0.01).0, Status::Ok);
    }
    let settings = [("/hinge/bob.mass", "3.0"), ("/hinge.motor.command", "0.25")];
    let settings = settings.map(|(path, value)| sincro_scene::overrides::Override::new(path, value));
    let expected = run(&fmu.loaded.with_overrides(&settings).unwrap());
    let column = &expected.table.column("/hinge.position").unwrap().values;
    assert_eq!(get(c, position).to_bits(), column[100].to_bits());
    assert_eq!(get(c, fmu.reference("hinge.command_held")), 0.25);
    // a tunable parameter acts from the next step on, a fixed one is refused
    assert_eq!(set(c, fmu.reference("gravity.'2'"), -1.0), Status::Ok, "{}", last_message());
    assert_eq!(step(c, 1.0, 0.01).0, Status::Ok);
    assert_eq!(set(c, fmu.reference("hinge.bob.mass"), -1.0), Status::Error);
    assert!(last_message().contains("not positive"), "{}", last_message());
    let fixed = fmu.catalogue.variables.iter().position(|v| matches!(v.role, sincro_fmu::variables::Role::Fixed(_)));
    assert_eq!(set(c, u32::try_from(fixed.unwrap()).unwrap(), 1.0), Status::Error);
    assert!(last_message().contains("before the simulation starts"), "{}", last_message());
    assert_eq!(set(c, position, 1.0), Status::Error);
    assert_eq!(set(c, fmu.reference("hinge.command"), f64::NAN), Status::Error);
    // after a reset everything is as it was exported
    assert_eq!(fmi3Reset(c), Status::Ok);
    assert_eq!(get(c, fmu.reference("hinge.bob.mass")), 2.0);
    fmi3FreeInstance(c);
}

#[test]
fn wrong_calls_are_errors() {
    let fmu = Fmu::scene("cart-pole-lqr", CS);
    assert!(fmu.instantiate("{another}").is_null());
    assert!(last_message().contains("token"), "{}", last_message());
    // SAFETY: null is what is tested
    unsafe {
        assert!(fmi2Instantiate(null(), 1, null(), null(), null(), 0, 0).is_null());
        assert!(
            fmi3InstantiateModelExchange(null(), null(), null(), false, false, null_mut(), Some(logger3)).is_null()
        );
    }
    let c = fmu.instantiate(&fmu.token);
    // in the wrong order
    assert_eq!(step(c, 0.0, 0.02).0, Status::Error);
    assert_eq!(fmi3ExitInitializationMode(c), Status::Error);
    assert_eq!(fmi3Terminate(c), Status::Error);
    assert_eq!(fmi3EnterContinuousTimeMode(c), Status::Error);
    assert_eq!(fmi3EnterInitializationMode(c, false, 0.0, f64::NAN, false, 0.0), Status::Error);
    assert_eq!(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), Status::Ok);
    assert_eq!(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), Status::Error);
    assert_eq!(fmi3ExitInitializationMode(c), Status::Ok);
    // SAFETY: null pointers and lengths that do not fit are what is tested
    unsafe {
        assert_eq!(fmi3GetFloat64(c, null(), 1, null_mut(), 1), Status::Error);
        assert_eq!(fmi3GetFloat64(c, null(), 0, null_mut(), 0), Status::Ok);
        assert_eq!(fmi3SetFloat64(c, null(), 7, null(), 7), Status::Error);
        assert_eq!(
            fmi3GetFloat64(c, &raw const fmu.token as *const u32, usize::MAX, null_mut(), usize::MAX),
            Status::Error
        );
        let (reference, mut values) = (9_999_u32, [0.0; 2]);
        assert_eq!(fmi3GetFloat64(c, &raw const reference, 1, values.as_mut_ptr(), 1), Status::Error);
        assert_eq!(fmi3GetFloat64(c, &raw const reference, 1, values.as_mut_ptr(), 2), Status::Error);
        assert_eq!(fmi3DoStep(c, 0.0, 0.02, true, null_mut(), null_mut(), null_mut(), null_mut()), Status::Error);
        assert_eq!(fmi3GetFMUState(c, null_mut()), Status::Error);
        assert_eq!(fmi3SetFMUState(c, null_mut()), Status::Error);
        assert_eq!(fmi3SetFMUState(c, 12_345 as *mut c_void), Status::Error);
        assert_eq!(fmi3SerializedFMUStateSize(c, null_mut(), null_mut()), Status::Error);
        assert_eq!(fmi3GetInt32(c, &raw const reference, 1, null_mut(), 1), Status::Error);
    }
    // a step that is no multiple of the base step, and one from another time
    assert_eq!(step(c, 0.0, 0.03).0, Status::Discard);
    assert!(last_message().contains("no whole number of base steps of 0.02 s"), "{}", last_message());
    assert_eq!(step(c, 5.0, 0.02).0, Status::Discard);
    assert_eq!(step(c, 0.0, -0.02).0, Status::Discard);
    assert_eq!(step(c, 0.0, f64::INFINITY).0, Status::Discard);
    assert_eq!(step(c, 0.0, 0.04), (Status::Ok, false, false, 0.04));
    // freed twice, and used after that
    fmi3FreeInstance(c);
    fmi3FreeInstance(c);
    fmi3FreeInstance(null_mut());
    assert_eq!(step(c, 0.04, 0.02).0, Status::Error);
    assert_eq!(fmi3Reset(c), Status::Error);
    assert_eq!(fmi2DoStep(16_777_215 as *mut c_void, 0.0, 1.0, 0), Status::Error);
}

#[test]
fn states_are_freed_once_and_bytes_are_checked() {
    let fmu = Fmu::scene("cart-pole-lqr", CS);
    let c = fmu.started(&[]);
    let mut state = null_mut();
    // SAFETY: places for the results
    unsafe {
        assert_eq!(fmi3GetFMUState(c, &raw mut state), Status::Ok);
        let mut n = 0;
        assert_eq!(fmi3SerializedFMUStateSize(c, state, &raw mut n), Status::Ok);
        let mut bytes = vec![0_u8; n];
        assert_eq!(fmi3SerializeFMUState(c, state, bytes.as_mut_ptr(), n - 1), Status::Error);
        assert_eq!(fmi3SerializeFMUState(c, state, bytes.as_mut_ptr(), n), Status::Ok);
        let mut copy = state;
        assert_eq!(fmi3FreeFMUState(c, &raw mut state), Status::Ok);
        assert!(state.is_null());
        assert_eq!(fmi3FreeFMUState(c, &raw mut state), Status::Ok);
        assert_eq!(fmi3FreeFMUState(c, &raw mut copy), Status::Error);
        assert_eq!(fmi3SetFMUState(c, copy), Status::Error);
        // any bit of the bytes that is wrong is an error, or a state; never a crash
        for k in 0..n {
            let mut damaged = bytes.clone();
            damaged[k] ^= 1 << (k % 8);
            let mut read = null_mut();
            if fmi3DeserializeFMUState(c, damaged.as_ptr(), n, &raw mut read) == Status::Ok {
                fmi3SetFMUState(c, read);
                fmi3FreeFMUState(c, &raw mut read);
            }
            assert_ne!(fmi3DeserializeFMUState(c, bytes.as_ptr(), k, &raw mut read), Status::Ok);
        }
    }
    fmi3FreeInstance(c);
}

#[test]
fn a_run_that_halts_returns_early_with_the_last_good_time() {
    let scene = "
        joint = [{ name = \"slide\", kind = \"prismatic\", axis = [1, 0, 0], motor = { mode = \"torque\" } }]
        [[body]]
        name = \"cart\"
        parent = \"/slide\"
        mass = 1.0
        inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
    ";
    let diagram = "
        sample_time = 0.01
        wires = [\"clock -> law -> /slide\"]
        block = [{ name = \"clock\", type = \"clock\" }, { name = \"law\", type = \"expression\", expression = \"1/(0.05 - u)\" }]
    ";
    let experiment = "title = \"t\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"/slide.position\"]\n";
    let folder = SceneFolder::of(scene, experiment).with("diagram.toml", diagram);
    let fmu = Fmu::of(load(&folder, &[], with_scripts()).unwrap(), CS);
    let c = fmu.started(&[]);
    let (status, terminate, early, last) = step(c, 0.0, 0.2);
    assert_eq!((status, terminate, early), (Status::Ok, true, true), "{}", last_message());
    assert!((last - 0.05).abs() < 1e-12, "{last}");
    assert!(last_message().contains("the simulation ended: block `law`"), "{}", last_message());
    assert!(get(c, fmu.reference("slide.position")).is_finite());
    assert_eq!(fmi3Terminate(c), Status::Ok);
    fmi3FreeInstance(c);
}

#[test]
fn intermediate_updates_are_called_between_base_steps_and_may_return_early() {
    thread_local! {
        static SEEN: RefCell<Vec<(f64, f64)>> = const { RefCell::new(Vec::new()) };
        static INSTANCE: RefCell<(usize, u32)> = const { RefCell::new((0, 0)) };
    }
    unsafe extern "C" fn update(
        _: *mut c_void,
        t: f64,
        _: bool,
        _: bool,
        _: bool,
        may_return: bool,
        request: *mut bool,
        until: *mut f64,
    ) {
        let (handle, reference) = INSTANCE.with(|instance| *instance.borrow());
        SEEN.with(|seen| seen.borrow_mut().push((t, get(handle as *mut c_void, reference))));
        // SAFETY: places for the answers
        unsafe {
            *request = may_return && t > 0.05;
            *until = t;
        }
    }
    let fmu = Fmu::scene("cart-pole-lqr", CS);
    let texts = [CString::new("test").unwrap(), CString::new(&*fmu.token).unwrap()];
    let path = CString::new(fmu.resources.to_str().unwrap()).unwrap();
    let (name, token, path) = (texts[0].as_ptr(), texts[1].as_ptr(), path.as_ptr());
    // SAFETY: texts that live until the call returns
    let c = unsafe {
        fmi3InstantiateCoSimulation(
            name,
            token,
            path,
            false,
            false,
            false,
            true,
            null(),
            0,
            null_mut(),
            None,
            Some(update),
        )
    };
    let position = fmu
        .catalogue
        .with_role(|role| matches!(role, sincro_fmu::variables::Role::Output(0)).then_some(()))
        .next()
        .unwrap()
        .0;
    INSTANCE.with(|instance| *instance.borrow_mut() = (c as usize, position));
    assert_eq!(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), Status::Ok);
    assert_eq!(fmi3ExitInitializationMode(c), Status::Ok);
    let (status, terminate, early, last) = step(c, 0.0, 0.2);
    assert_eq!((status, terminate, early), (Status::Ok, false, true));
    assert!((last - 0.06).abs() < 1e-12);
    let seen = SEEN.with(|seen| seen.borrow().clone());
    assert_eq!(seen.len(), 3);
    // looking in between changes nothing
    let expected = run(&fmu.loaded);
    let name = &fmu.catalogue.recorded[0].value;
    let column = &expected.table.column(name).unwrap().values;
    for (k, (_, x)) in seen.iter().enumerate() {
        assert_eq!(x.to_bits(), column[k + 1].to_bits());
    }
    fmi3FreeInstance(c);
}

#[test]
fn model_exchange_gives_the_equations() {
    let fmu = Fmu::scene("spring-dynamic", BOTH);
    let texts = [CString::new("test").unwrap(), CString::new(&*fmu.token).unwrap()];
    let path = CString::new(fmu.resources.to_str().unwrap()).unwrap();
    // SAFETY: texts that live until the call returns
    let c = unsafe {
        fmi3InstantiateModelExchange(
            texts[0].as_ptr(),
            texts[1].as_ptr(),
            path.as_ptr(),
            false,
            false,
            null_mut(),
            Some(logger3),
        )
    };
    assert!(!c.is_null(), "{}", last_message());
    assert_eq!(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), Status::Ok);
    assert_eq!(fmi3ExitInitializationMode(c), Status::Ok, "{}", last_message());
    let n = fmu.catalogue.n_states;
    let (mut x, mut rates) = (vec![0.0; n], vec![0.0; n]);
    // SAFETY: vectors of that length
    unsafe {
        assert_eq!(fmi3GetContinuousStates(c, x.as_mut_ptr(), n), Status::Ok);
        assert_eq!(fmi3GetContinuousStateDerivatives(c, rates.as_mut_ptr(), n), Status::Ok);
        assert_eq!(fmi3GetContinuousStateDerivatives(c, rates.as_mut_ptr(), n - 1), Status::Error);
        x[0] = f64::NAN;
        assert_eq!(fmi3SetContinuousStates(c, x.as_ptr(), n), Status::Error);
    }
    // coordinates change with the velocities
    assert_eq!(rates[..n / 2], x[n / 2..]);
    // the matrix of a mechanism: a displaced velocity displaces the rate of its coordinate as much
    let state =
        fmu.catalogue.with_role(|role| if let sincro_fmu::variables::Role::State(k) = role { Some(*k) } else { None });
    let velocity = state.filter(|(_, _, k)| *k == n / 2).map(|(vr, ..)| vr).next().unwrap();
    let rate = fmu
        .catalogue
        .with_role(|role| matches!(role, sincro_fmu::variables::Role::Derivative(0)).then_some(()))
        .next()
        .unwrap()
        .0;
    let (seed, mut sensitivity) = (1.0, 0.0);
    // SAFETY: one unknown, one known
    unsafe {
        let status = fmi3GetDirectionalDerivative(
            c,
            &raw const rate,
            1,
            &raw const velocity,
            1,
            &raw const seed,
            1,
            &raw mut sensitivity,
            1,
        );
        assert_eq!(status, Status::Ok, "{}", last_message());
    }
    assert_eq!(sensitivity, 1.0);
    // the transposed matrix of one entry is the same
    let mut adjoint = 0.0;
    // SAFETY: one unknown, one known
    unsafe {
        let (unknown, known) = (&raw const rate, &raw const velocity);
        let status = fmi3GetAdjointDerivative(c, unknown, 1, known, 1, &raw const seed, 1, &raw mut adjoint, 1);
        assert_eq!(status, Status::Ok, "{}", last_message());
        assert_eq!(adjoint, 1.0);
        let status = fmi3GetAdjointDerivative(c, unknown, 1, known, 1, &raw const seed, 2, &raw mut adjoint, 1);
        assert_eq!(status, Status::Error);
        let status = fmi3GetAdjointDerivative(c, unknown, 1, known, 1, null(), 1, &raw mut adjoint, 1);
        assert_eq!(status, Status::Error);
    }
    fmi3FreeInstance(c);
}

#[test]
fn derivatives_of_co_simulation_are_there_with_the_equations_alone() {
    let derivative = |c: *mut c_void, unknown: u32, known: u32| {
        let (seed, mut sensitivity) = (1.0, f64::NAN);
        let (unknown, known) = (&raw const unknown, &raw const known);
        // SAFETY: one unknown, one known
        let status = unsafe {
            fmi3GetDirectionalDerivative(c, unknown, 1, known, 1, &raw const seed, 1, &raw mut sensitivity, 1)
        };
        (status, sensitivity)
    };
    let fmu = Fmu::scene("acrobot", BOTH);
    let c = fmu.started(&[]);
    let of = |pick: fn(&sincro_fmu::variables::Role) -> bool| {
        fmu.catalogue.with_role(|role| pick(role).then_some(())).map(|(vr, ..)| vr).next().unwrap()
    };
    use sincro_fmu::variables::Role;
    let (rate, input) = (of(|role| matches!(role, Role::Derivative(2))), of(|role| matches!(role, Role::Input(_))));
    let angle = of(|role| matches!(role, Role::State(1)));
    let h = fmu.loaded.experiment.step;
    let (status, at_start) = derivative(c, rate, input);
    assert_eq!(status, Status::Ok, "{}", last_message());
    for k in 0..20 {
        assert_eq!(step(c, f64::from(k) * h, h).0, Status::Ok, "{}", last_message());
    }
    assert_ne!(get(c, angle), 0.0);
    let (status, later) = derivative(c, rate, input);
    assert_eq!(status, Status::Ok);
    assert!(at_start != 0.0 && later != at_start, "{at_start} {later}");
    fmi3FreeInstance(c);
    // without the equations there is nothing to differentiate
    let fmu = Fmu::scene("acrobot", CS);
    let c = fmu.started(&[]);
    assert_eq!(derivative(c, 0, 0).0, Status::Error);
    let input = fmu.catalogue.with_role(|role| matches!(role, Role::Input(_)).then_some(())).next().unwrap().0;
    let output = fmu.catalogue.with_role(|role| matches!(role, Role::Output(_)).then_some(())).next().unwrap().0;
    assert_eq!(derivative(c, output, input).0, Status::Error);
    assert!(last_message().contains("--kind both"), "{}", last_message());
    fmi3FreeInstance(c);
}

#[test]
fn scenes_that_switch_are_refused_for_model_exchange_with_the_reason() {
    let reasons = |name: &str| {
        sincro_fmu::switching::reasons(&load(&repository_scene(name), &[], with_scripts()).unwrap()).join("; ")
    };
    assert!(reasons("bouncing-ball").contains("touch"));
    assert!(reasons("four-bar").contains("closes a loop"));
    assert!(reasons("two-dof-position").contains("ideal, or has a limit"));
    assert!(reasons("pcontroller").contains("script"));
    assert_eq!(reasons("cart-pole-lqr"), "");
    assert_eq!(reasons("spring-dynamic"), "");
}

#[test]
fn random_calls_leave_the_process_alive() {
    let fmu = Fmu::scene("cart-pole-lqr", CS);
    let mut handles = [fmu.instantiate(&fmu.token), fmu.instantiate(&fmu.token), null_mut(), 64 as *mut c_void];
    let mut states = [null_mut(), null_mut(), 16 as *mut c_void];
    let mut seed = 7_u64;
    let mut draw = |n: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % n
    };
    let times = [0.0, 0.02, 0.04, 1.0, -1.0, f64::NAN, f64::INFINITY];
    for _ in 0..20_000 {
        let c = handles[draw(4)];
        let reference = u32::try_from(draw(70)).unwrap();
        // SAFETY: pointers to places of this function, or null
        unsafe {
            match draw(16) {
                0 => {
                    fmi3EnterInitializationMode(c, false, 0.0, times[draw(3)], false, 0.0);
                }
                1 => {
                    fmi3ExitInitializationMode(c);
                }
                2..=4 => {
                    step(c, times[draw(7)], times[draw(7)]);
                }
                5 => {
                    fmi3GetFMUState(c, &raw mut states[draw(3)]);
                }
                6 => {
                    fmi3SetFMUState(c, states[draw(3)]);
                }
                7 => {
                    fmi3FreeFMUState(c, &raw mut states[draw(3)]);
                }
                8 => {
                    fmi3Terminate(c);
                }
                9 if draw(4) == 0 => {
                    fmi3Reset(c);
                }
                10 => {
                    set(c, reference, times[draw(7)]);
                }
                11 => {
                    let mut value = 0.0;
                    fmi3GetFloat64(c, &raw const reference, 1, &raw mut value, 1);
                }
                12 => {
                    fmi3EnterEventMode(c);
                }
                13 => {
                    fmi3SetTime(c, times[draw(7)]);
                }
                14 if draw(50) == 0 => {
                    fmi3FreeInstance(c);
                    handles[draw(2)] = fmu.instantiate(&fmu.token);
                }
                _ => {
                    fmi3SerializedFMUStateSize(c, states[draw(3)], null_mut());
                }
            }
        }
    }
    for c in handles {
        fmi3FreeInstance(c);
    }
}
