-- As propeller-lua/propeller.lua, but for one word: the torque has the sense of the parameter `spin`, against the rotation.
-- Old style (V-REP up to 3.4): the whole text is run at every call, sim_call_type says which call it is.

if (sim_call_type==sim_childscriptcall_initialization) then
	joint=simGetObjectHandle('Motor')
	propeller=simGetObjectAssociatedWithScript(sim_handle_self)
	ts=simGetSimulationTimeStep()
	p0=simGetObjectPosition(propeller,-1)
	-- Table 1
	R=simGetScriptSimulationParameter(sim_handle_self,'R')
	rho=simGetScriptSimulationParameter(sim_handle_self,'rho')
	c=simGetScriptSimulationParameter(sim_handle_self,'c')
	N=simGetScriptSimulationParameter(sim_handle_self,'N')
	Cla=simGetScriptSimulationParameter(sim_handle_self,'Cla')
	theta0=simGetScriptSimulationParameter(sim_handle_self,'theta0')
	Cd0=simGetScriptSimulationParameter(sim_handle_self,'Cd0')
	kCd=simGetScriptSimulationParameter(sim_handle_self,'kCd')
	spin=simGetScriptSimulationParameter(sim_handle_self,'spin')
	A=math.pi*R^2
	sigma=N*c/(math.pi*R)
	k1=sigma*Cla/8
end

if (sim_call_type==sim_childscriptcall_actuation) then
	Omega=simGetJointTargetVelocity(joint)+1e-5
	v=simGetVelocity(propeller)
	m=simGetObjectMatrix(propeller,-1)

	-- velocity along the axis: elements 9, 10, 11 are the third row of the rotation
	v_Bz=v[1]*m[9]+v[2]*m[10]+v[3]*m[11]
	V=math.sqrt(v[1]^2+v[2]^2+v[3]^2)
	alpha=math.asin(v_Bz/(V+1e-6))
	r=V/(Omega*R)
	mu=r*math.cos(alpha)
	nu=r*math.sin(alpha)

	-- x^4 + 2*A1*x^3 + A2*x^2 + 2*A3*x + A4 = 0, by Ferrari
	k2=k1*theta0*(2/3+mu^2)
	A1=-nu
	A2=r^2-k1^2
	A3=nu*mu^2+k1*k2
	A4=nu^2*mu^2-k2^2
	b1=0.5*(A1^2+A2-1)
	b2=A3-b1
	b3=0.5*(A2*A4-A1^2*A4-A3^2)
	c1=b1^2-3*b2
	c2=2*b1^3-9*b1*b2+27*b3
	c3=(0.5*(c2+math.sqrt(c2^2-4*c1^3)))^(1/3)
	d1=-(b1+c3+c1/c3)/3
	d2=math.sqrt(d1^2-A4)
	d3=(d1-A3)/d2
	auxsol=A1*d3-2*d2
	if (auxsol<0) then
		sg=-1
	else
		sg=1
	end
	x=0.5*(-A1-d3*sg+math.sqrt(A1^2+d3^2-4*d1+2*math.abs(auxsol)))

	CT=2*(k2-k1*x)
	T=rho*A*(Omega*R)^2*CT
	CQ=sigma*(Cd0+kCd*theta0^2)*(1+mu^2)/8+2*k1*(theta0/3-x/2)+0.25*sigma*kCd*x*(x-4*theta0/3)
	Q=CQ*rho*A*(Omega*R)^2*R

	simSetFloatSignal('thrust',T)
	simSetFloatSignal('torque',Q)
	simSetFloatSignal('inflow',x)

	-- from the propeller's axes to the world's: without the position the matrix only turns
	m[4]=0
	m[8]=0
	m[12]=0
	force=simMultiplyVector(m,{0,0,T})
	torque=simMultiplyVector(m,{0,0,-spin*Q})
	simAddForceAndTorque(propeller,force,torque)
end
