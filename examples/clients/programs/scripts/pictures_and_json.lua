-- scene: arm, object: /base, duration: 0.2
-- Saves what a vision sensor sees, keeps numbers as JSON, and computes with matrices.
sim = require 'sim'
json = require 'dkjson'

function sysCall_sensing()
    local eye = sim.getObject('/eye')
    local image, size = sim.getVisionSensorImg(eye)
    local saved = sim.saveImage(image, size, 0, 'what the eye sees.png', -1)
    local png, bmp = sim.saveImage(image, size, 0, '.png', -1), sim.saveImage(image, size, 0, '.bmp', -1)
    local text = json.encode({ size = size, place = sim.getObjectPosition(eye, -1) }, { indent = true })
    local back = json.decode(text)
    local pose = Matrix4x4:frompose(sim.getObjectPose(eye, -1))
    local point = pose * pose:inv() * Vector4 { 1, 2, 3, 1 }
    good = saved == 1 and png:sub(2, 4) == 'PNG' and bmp:sub(1, 2) == 'BM' and #bmp == 54 + 3 * size[1] * size[2]
        and back.size[1] == size[1] and (point - Vector4 { 1, 2, 3, 1 }):norm() < 1e-9
end

function sysCall_cleanup()
    print({ good = good })
    if good then print('passed') end
end
