% bounce times picked from the wav file (s)
t = [0.378 1.027 1.587 2.064 2.481 2.835 3.139 3.403];
dt = diff(t);
e = mean(dt(2:end)./dt(1:end-1))
