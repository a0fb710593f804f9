function R = rotation_of(angles)
  % Rotation matrix of the Euler angles of the API [rad]: R = Rx Ry Rz.

  a = angles(1);  b = angles(2);  c = angles(3);
  R = [1, 0, 0; 0, cos(a), -sin(a); 0, sin(a), cos(a)] * [cos(b), 0, sin(b); 0, 1, 0; -sin(b), 0, cos(b)] * [cos(c), -sin(c), 0; sin(c), cos(c), 0; 0, 0, 1];
end
