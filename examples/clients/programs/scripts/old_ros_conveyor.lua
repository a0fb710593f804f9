-- scene: table, object: /floor, duration: 0.5
-- V-REP 3 with the ROS interface: publishes where a body is, stores a texture, gives the body a picture, ends cleanly.
if (sim_call_type == sim_childscriptcall_initialization) then
    place = simExtRosInterface_advertise('/place', 'geometry_msgs/Point')
    listener = simExtRosInterface_subscribe('/place', 'geometry_msgs/Point', 'placed')
    body = simCreatePureShape(0, 8, { 0.1, 0.1, 0.1 }, 1, nil)
    simSetObjectPosition(body, -1, { 2, 0, 0.5 })
    plane, texture, size = simCreateTexture('', 0, { 0.2, 0.2 }, nil, nil, 0, { 4, 4 })
    simWriteTexture(texture, 0, string.rep(string.char(200, 10, 10), 16))
    simSetShapeTexture(body, texture, sim_texturemap_plane, 3, { 0.15, 0.15 })
    ui = simGetUIHandle('conveyor')
    simSetUIProperty(ui, simBoolOr32(simGetUIProperty(ui), sim_ui_property_visible))
    missing = simCreateTexture('pictures/nobody.png', 1, nil, nil, nil, 0, nil)
    heard = 0
end

function placed(point) heard, height = heard + 1, point.z end

if (sim_call_type == sim_childscriptcall_actuation) then
    p = simGetObjectPosition(body, -1)
    simExtRosInterface_publish(place, { x = p[1], y = p[2], z = p[3] })
end

if (sim_call_type == sim_childscriptcall_cleanup) then
    simExtRosInterface_shutdownPublisher(place)
    simExtRosInterface_shutdownSubscriber(listener)
    good = heard > 5 and height < 0.5 and simGetShapeTextureId(body) == texture and missing == -1
        and string.byte(simReadTexture(texture, 0, 3, 3, 1, 1)) == 200 and simGetUIProperty(ui) == sim_ui_property_visible
    if good then print('passed') end
end
