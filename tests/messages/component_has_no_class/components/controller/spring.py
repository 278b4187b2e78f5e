import math

LIMIT = 5
