-- scene: arm, object: /base, duration: 5, threaded: true
-- Jerk-limited motions of V-REP 3 in a thread.
joints={simGetObjectHandle('joint1'),simGetObjectHandle('joint2'),simGetObjectHandle('joint3')}
currentVel={0,0,0,0,0,0}
currentAccel={0,0,0,0,0,0}
maxVel={1,1,1}
maxAccel={2,2,2}
maxJerk={10,10,10}
simRMLMoveToJointPositions(joints,-1,currentVel,currentAccel,maxVel,maxAccel,maxJerk,{0.5,0.9,-0.5},{0,0,0})
simWait(0.5)
if (math.abs(simGetJointPosition(joints[1])-0.5)<0.01 and math.abs(simGetJointPosition(joints[3])+0.5)<0.01) then
    print('passed')
end
