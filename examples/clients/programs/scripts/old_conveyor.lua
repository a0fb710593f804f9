-- scene: table, object: /floor, duration: 2
-- A slab that is given a velocity at each step carries a box along; a trace is made of the box.
if (sim_call_type==sim_childscriptcall_initialization) then
    belt=simCreatePureShape(0,8+16,{2,0.4,0.1},1)
    simSetObjectPosition(belt,-1,{-2,0,0.06})
    box=simCreatePureShape(0,8,{0.1,0.1,0.1},0.5)
    simSetObjectPosition(box,-1,{-2.5,0,0.1601})
    local vertices,indices=simGetShapeMesh(box)
    trace=simCreateMeshShape(0,0,vertices,indices)
    simAddObjectToSelection(sim_handle_single,trace)
    simCopyPasteSelectedObjects()
    copy=simGetObjectLastSelection()
    ui=simGetUIHandle('belt')
end
if (sim_call_type==sim_childscriptcall_actuation) then
    local speed=0.3
    if (simGetUIEventButton(ui)==1) then speed=0 end
    simResetDynamicObject(belt)
    local m=simGetObjectMatrix(belt,-1)
    m[4]=0
    m[8]=0
    m[12]=0
    local v=simMultiplyVector(m,{speed,0,0})
    simSetObjectFloatParameter(belt,sim_shapefloatparam_init_velocity_x,v[1])
    simSetObjectFloatParameter(belt,sim_shapefloatparam_init_velocity_y,v[2])
    simSetObjectFloatParameter(belt,sim_shapefloatparam_init_velocity_z,v[3])
end
if (sim_call_type==sim_childscriptcall_cleanup) then
    local p,b=simGetObjectPosition(box,-1),simGetObjectPosition(belt,-1)
    local isThere=p[1]>-2.5+0.5 and p[1]<-2.5+0.6 and math.abs(b[1]+2)<0.02
    if (isThere and copy~=trace and simGetObjectParent(belt)==-1) then print('passed') end
end
