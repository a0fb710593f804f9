#!/bin/sh
# Six parameters of the compliant arm of the thesis, from the deflections of its four springs.
here=$(dirname "$0")
s1=/motor1/spring1
s2=$s1/motor2/spring2
s3=$s2/motor3/spring3
s4=$s3/motor4/spring4
"${SINCRO:-sincro}" fit "$here/../../scenes/alexandros-position" --data "$here/data/arm.csv" \
  --signal "$s1.position=spring1@2e-4" --signal "$s2.position=spring2@2e-4" \
  --signal "$s3.position=spring3@2e-4" --signal "$s4.position=spring4@2e-4" \
  --free "$s1.spring.stiffness=3.4,$s2.spring.stiffness=2.4,$s3.spring.stiffness=0.9,$s4.spring.stiffness=1.7" \
  --free "$s1.damping=0.03,$s4.damping=0.03" "$@"
