-- scene: table, object: /floor, duration: 0.1
-- Properties of CoppeliaSim 4.7 and later, tables stored with objects, MessagePack.
sim = require 'sim'

function sysCall_init()
    local brick = sim.getObject('/brick')
    assert(math.abs(sim.getFloatProperty(brick, 'mass') - 6) < 1e-9)
    sim.setTableProperty(brick, 'customData.list', { 1, 2, 3 })
    assert(#sim.getTableProperty(brick, 'customData.list') == 3)
    sim.setIntProperty(sim.handle_scene, 'signal.count', 4)
    assert(sim.getInt32Signal('count') == 4)
    assert(sim.getIntProperty(brick, 'customData.none', { noError = true }) == nil)
    sim.writeCustomTableData(brick, 'info', { name = 'brick', size = { 0.1, 0.2, 0.3 } })
    assert(sim.readCustomTableData(brick, 'info').size[3] == 0.3)
    sim.writeCustomDataBlock(brick, 'raw', sim.packTable { a = true })
    assert(sim.unpackTable(sim.readCustomDataBlock(brick, 'raw')).a == true)
    local mp = require 'messagePack'
    assert(mp.unpack(mp.pack { x = 1.5 }).x == 1.5)
    local ok, why = pcall(sim.getFloatProperty, brick, 'noSuchThing')
    assert(not ok and why:find('no property'))
    print('passed')
end
