//! Textures, meshes, hulls and frames of shapes; files that scripts save.

use sincro_sim::results::Status;
use sincro_testing::scenes::{MOTOR_PENDULUM, MOTOR_PENDULUM_EXPERIMENT};

use super::world::{folder, open, run, said, stop, with_script};
use sincro_sim::load;
use sincro_testing::with_scripts;

/// A picture of 2 × 1 pixels: red, green.
fn png() -> Vec<u8> {
    use sincro_scene::camera::png::{Channels, encode};
    encode(&[255, 0, 0, 0, 255, 0], [2, 1], Channels::Rgb)
}

#[test]
fn a_texture_of_a_file_is_on_its_shape_and_can_be_given_to_others() {
    let code = "function sysCall_init()
            local shape, texture, size = sim.createTexture('/data/somebody/project/pictures/flag.png', 0, { 0.2, 0.1 })
            print(shape > 0, texture, size[1], size[2], sim.getShapeTextureId(shape))
            local box = sim.createPureShape(0, 0, { 0.1, 0.1, 0.1 }, 1, nil)
            print(sim.getShapeTextureId(box))
            sim.setShapeTexture(box, texture, sim.texturemap_plane, 3, { 0.15, 0.15 })
            print(sim.getShapeTextureId(box), sim.getTextureId('flag.png'))
            print(sim.readTexture(texture):byte(1, 6))
            sim.writeTexture(texture, 0, string.char(7, 8, 9), 1, 0, 1, 1)
            print(sim.readTexture(texture, 0, 1, 0, 1, 1):byte(1, 3))
            sim.setShapeTexture(box, -1, 0, 0, { 1, 1 })
            print(sim.getShapeTextureId(box), pcall(sim.setShapeTexture, box, 77, 0, 0, { 1, 1 }))
            print(simCreateTexture('nothing.png', 1, nil, nil, nil, 0, nil))
            local image, size = sim.loadImage(0, 'pictures/flag.png')
            print(#image, size[1], size[2], #sim.loadImage(1, 'pictures/flag.png'))
        end";
    let scene = format!("{MOTOR_PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n");
    let folder = folder(&[("scene.toml", &scene), ("experiment.toml", MOTOR_PENDULUM_EXPERIMENT), ("a.lua", code)]);
    std::fs::create_dir(folder.join("pictures")).unwrap();
    std::fs::write(folder.join("pictures/flag.png"), png()).unwrap();
    let run = run(&load(&folder, &[], with_scripts()).unwrap());
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    let told: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    let is_own = |line: &&&str| !line.contains("is kept: pictures") && !line.contains("no texture is made");
    let own: Vec<&str> = told.iter().filter(is_own).copied().collect();
    assert_eq!(own[..5], ["true\t1\t2\t1\t1", "-1", "1\t1\t{2, 1}", "255\t0\t0\t0\t255\t0", "7\t8\t9"]);
    assert!(own[5].starts_with("-1\tfalse\t") && own[5].contains("there is no texture 77"), "{own:?}");
    assert_eq!(own[6..], ["-1\t-1\t{0, 0}", "6\t2\t1\t8"]);
    assert!(told.iter().any(|line| line.contains("pictures show its colour")), "{told:?}");
}

#[test]
fn a_hull_has_the_corners_alone_and_a_frame_is_turned_under_its_surface() {
    let code = "function sysCall_init()
            local corners = {}
            for i = 0, 7 do
                for k = 0, 2 do corners[#corners + 1] = (i >> k & 1) * (k + 1) end
            end
            for i = 1, 20 do corners[#corners + 1] = 0.5 end
            corners[#corners + 1] = 0.5
            local vertices, indices = sim.getQHull(corners)
            print(#vertices, #indices)
            local shape = sim.createMeshShape(3, 0, vertices, indices)
            sim.setObjectOrientation(shape, -1, { 0, 0, math.pi / 2 })
            local size = sim.getShapeBB(shape)
            sim.reorientShapeBoundingBox(shape, -1)
            local turned, angles = sim.getShapeBB(shape), sim.getObjectOrientation(shape, -1)
            local near = function(a, b) return math.abs(a - b) < 1e-9 end
            print(near(size[1], 1), near(size[2], 2), near(turned[1], 2), near(turned[2], 1), near(angles[3], 0))
            local before = sim.getObjectPosition(shape, -1)
            sim.relocateShapeFrame(shape, { 3, 0, 0, 0, 0, 0, 1 })
            print(near(sim.getObjectPosition(shape, -1)[1], 3), near(sim.getObjectFloatParam(shape, 15), before[1] - 1 - 3))
            sim.relocateShapeFrame(shape, { 0, 0, 0, 0, 0, 0, 0 })
            print(near(sim.getObjectPosition(shape, -1)[1], before[1]))
            print(select(2, pcall(sim.reorientShapeBoundingBox, sim.getObject('.'), -1)))
            print(sim.getObjectInt32Param(shape, sim.shapeintparam_compound), sim.getObjectInt32Param(shape, sim.shapeintparam_convex))
        end";
    let told = said(code);
    assert_eq!(told[..4], ["24\t36", "true\ttrue\ttrue\ttrue\ttrue", "true\ttrue", "true"], "{told:?}");
    assert!(told[4].contains("it is that of a body"), "{told:?}");
    assert_eq!(told[5], "0\t0");
}

#[test]
fn meshes_models_and_scenes_are_kept_with_the_run() {
    let code = "function sysCall_sensing()
            if done then return end
            done = true
            local box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 1, 1, 1 })
            local vertices, indices = sim.getShapeMesh(box)
            sim.exportMesh(4, '/data/somebody/out/box', 0, 1000, { vertices }, { indices })
            sim.exportMesh(0, 'box.obj', 0, 1, vertices, indices)
            print(sim.saveScene('C:/scenes/mine.ttt'))
            print(sim.saveModel(sim.getObject('/hinge'), '/data/somebody/models/pendulum.ttm'))
            print(sim.getObjectAlias(sim.loadModel('/data/somebody/models/pendulum.ttm')))
            print(pcall(sim.exportMesh, 5, 'box.dae', 0, 1, vertices, indices))
            print(sim.handleMill(sim.handle_all), pcall(sim.handleMill, 3))
        end";
    let run = run(&with_script(code, "").unwrap());
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    let names: Vec<&str> = run.images.iter().map(|image| image.name.as_str()).collect();
    assert_eq!(names, ["box.obj", "box.stl", "mine.toml", "pendulum.ttm"]);
    let file = |k: usize| &run.images[k].bytes;
    assert_eq!(u32::from_le_bytes(file(1)[80..84].try_into().unwrap()), 12);
    assert!(file(0).starts_with(b"g mesh0\nv "));
    let scene = String::from_utf8(file(2).clone()).unwrap();
    assert!(scene.contains("name = \"arm\"") && scene.contains("[[script]]\nobject = \"/hinge/arm\"\n"), "{scene}");
    // it is a scene as any other, whose script does the same
    let again = open(&[("scene.toml", &scene), ("experiment.toml", MOTOR_PENDULUM_EXPERIMENT)]);
    let again = super::world::run(&again.unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(again.images.iter().map(|image| image.name.as_str()).collect::<Vec<_>>(), names);
    let told: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(told[..3], ["1", "1", "pendulum"]);
    assert!(told[3].contains("meshes are not written in the format 5"), "{told:?}");
    assert!(told[4].starts_with("0\tfalse") && told[4].contains("nothing is milled here"), "{told:?}");
    assert!(told[5].contains("saved as `mine.toml`") && told[5].contains("1 objects"), "{told:?}");
}

#[test]
fn files_are_written_by_scripts_of_a_run_alone() {
    let (reason, _) = stop("function sysCall_init() sim.exportMesh(0, '..', 0, 1, { 0, 0, 0 }, { 0, 0, 0 }) end");
    assert!(reason.contains("is no name of a file"), "{reason}");
    let (reason, _) = stop("function sysCall_init() sim.exportMesh(0, 'a', 0, 1, { 0, 0, 0 }, { 0, 0, 1 }) end");
    assert!(reason.contains("there is no corner 1"), "{reason}");
}

#[test]
fn windows_of_v_rep_3_keep_their_properties_and_buttons() {
    let code = "function sysCall_init()
            local ui = simGetUIHandle('panel')
            print(simGetUIProperty(ui))
            simSetUIProperty(ui, sim.boolOr32(simGetUIProperty(ui), sim_ui_property_visible))
            print(simGetUIProperty(ui) == sim_ui_property_visible)
            local made = simCreateUI('made', 0, { 10, 10 }, { 8, 8 })
            local a, b = simCreateUIButton(made, { 0, 0 }, { 2, 2 }, 5), simCreateUIButton(made, { 0, 2 }, { 2, 2 }, 6)
            print(made ~= ui, a, b, simGetUIButtonProperty(made, b))
            print(simRemoveUI(made), simGetUIButtonProperty(made, b))
        end";
    assert_eq!(said(code), ["0", "true", "true\t1\t2\t6", "1\t0"]);
}
