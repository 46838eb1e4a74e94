import numpy as np

# contact times from audio, seconds
t_contact = np.array([0.4504, 1.2108, 1.8472, 2.3827, 2.8309, 3.2094, 3.5264])
