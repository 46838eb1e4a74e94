# basketball, all in cm
drop <- c(50, 80, 110, 140, 170)
rebound <- c(25.8, 40.4, 56.6, 71.9, 87.9)
plot(drop, rebound)
