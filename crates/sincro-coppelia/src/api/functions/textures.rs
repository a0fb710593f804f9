//! Functions: textures. They are kept and told again: pictures show the colours of shapes.

use super::{Function, Outcome, done, handle, one};
use crate::api::{ApiError, Arguments, Search, SimApi, Value};
use sincro_vision::picture_files::decode;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "createTexture",
        tip: "int shapeHandle,int textureId,int[2] resolution=sim.createTexture(string fileName,int options=0,float[2] planeSizes=nil,float[2] scalingUV=nil,float[2] xy_g=nil,int fixedResolution=0,int[2] resolution=nil)",
        run: create,
    },
    Function {
        name: "setShapeTexture",
        tip: "sim.setShapeTexture(int shapeHandle,int textureId,int mappingMode,int options,float[2] uvScaling,float[3] position=nil,float[3] orientation=nil)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            let number = a.int(1)?;
            sim.set_texture(own, number)?;
            if number != -1 {
                let path = sim.registry.entry(own)?.path.clone();
                sim.log(300, &format!("the texture of `{path}` is kept: pictures show its colour"));
            }
            done()
        },
    },
    Function {
        name: "getShapeTextureId",
        tip: "int textureId=sim.getShapeTextureId(int shapeHandle)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            one(sim.registry.textures.on(own).unwrap_or(-1))
        },
    },
    Function {
        name: "getTextureId",
        tip: "int textureId,int[2] resolution=sim.getTextureId(string textureName,int options=0)",
        run: |sim, a| {
            let shape = sim.registry.find(a.text(0)?, Search::default()).ok();
            let found = sim.registry.textures.named(a.text(0)?).or_else(|| sim.registry.textures.on(shape?));
            let size = found.map(|number| sim.registry.textures.get(number).map(|texture| texture.size()));
            Ok(vec![Value::Int(found.unwrap_or(-1)), sides(size.transpose()?.unwrap_or_default())])
        },
    },
    Function {
        name: "readTexture",
        tip: "buffer textureData=sim.readTexture(int textureId,int options=0,int posX=0,int posY=0,int sizeX=0,int sizeY=0)",
        run: |sim, a| {
            let texture = sim.registry.textures.get(a.int(0)?)?;
            Ok(vec![Value::Bytes(texture.read(texture.rectangle(part(a, 2)?)?)?)])
        },
    },
    Function {
        name: "writeTexture",
        tip: "sim.writeTexture(int textureId,int options,buffer textureData,int posX=0,int posY=0,int sizeX=0,int sizeY=0,float interpol=0.0)",
        run: |sim, a| {
            let texture = sim.registry.textures.get(a.int(0)?)?;
            let rectangle = texture.rectangle(part(a, 3)?)?;
            texture.write(rectangle, a.bytes(2)?)?;
            done()
        },
    },
    Function {
        name: "loadImage",
        tip: "buffer image,int[2] resolution=sim.loadImage(int options,string filename)",
        run: load,
    },
];

/// Columns and rows, as clients take them.
fn sides(size: [usize; 2]) -> Value {
    Value::List(size.map(|n| Value::Int(n as i64)).to_vec())
}

/// A flat shape with a texture of a file; without a name a black one. Nothing of a file that is not there: −1.
fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let plane = if a.has(2) { a.reals::<2>(2)? } else { [1.0; 2] };
    let size = if a.has(6) { a.reals::<2>(6)? } else { [256.0; 2] };
    let size = size.map(|n| if n.fract() == 0.0 && (1.0..1e6).contains(&n) { n as usize } else { 0 });
    Ok(match sim.create_texture(a.text(0)?, plane, size)? {
        Some((shape, number, size)) => vec![Value::from(shape), Value::Int(number), sides(size)],
        None => vec![Value::Int(-1), Value::Int(-1), sides([0; 2])],
    })
}

/// First column and row and numbers of columns and rows, from argument `k` on.
fn part(a: Arguments<'_>, k: usize) -> Result<[i64; 4], ApiError> {
    Ok([a.int_or(k, 0)?, a.int_or(k + 1, 0)?, a.int_or(k + 2, 0)?, a.int_or(k + 3, 0)?])
}

/// A picture as bytes, with opacity if bit 0 of the options is set.
fn load(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let has_opacity = a.int(0)? & 1 != 0;
    let file = match a.get(1) {
        Value::Bytes(bytes) => bytes.clone(),
        _ => sim.picture_file(a.text(1)?)?,
    };
    let picture = decode(&file).map_err(|why| ApiError(format!("the picture is not read: {why}")))?;
    let size = sides(picture.size);
    Ok(vec![Value::Bytes(if has_opacity { picture.rgba } else { picture.rgb() }), size])
}
