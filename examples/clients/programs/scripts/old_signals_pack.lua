-- scene: arm, object: /base, duration: 0.5
-- Packed numbers in string signals, tubes, bits of 32 as V-REP's Lua had them.
if (sim_call_type==sim_childscriptcall_initialization) then
    simSetStringSignal('data',simPackFloats({1,2.5,-4}))
    data=simUnpackFloats(simGetStringSignal('data'))
    ints=simUnpackInts(simPackInts({7,-8}))
    simSetIntegerSignal('n',3)
    simSetFloatSignal('x',0.5)
    tubeA=simTubeOpen(0,'line',10)
    tubeB=simTubeOpen(0,'line',10)
    simTubeWrite(tubeA,'packet')
    mask=simBoolOr32(simBoolAnd32(255,15),64)
    message=simGetSimulatorMessage()
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    ok=(data[2]==2.5) and (ints[2]==-8) and (simGetIntegerSignal('n')==3) and (simGetFloatSignal('x')==0.5)
    simClearFloatSignal('x')
    ok=ok and (simGetFloatSignal('x')==nil) and (simTubeRead(tubeB)=='packet') and (mask==79) and (message==-1)
    if (ok) then print('passed') end
end
