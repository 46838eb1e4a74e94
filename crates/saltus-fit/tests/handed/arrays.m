% golf ball, granite
drop_cm = [50 75 100 125 150];
rebound_cm = [35.2 53.2 70.3 88.1 106.5];
