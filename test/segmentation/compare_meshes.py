"""Prints the largest distance [m] of equal vertices of two OBJ files; fails if their numbers differ."""
import sys


def vertices(path):
    with open(path) as file:
        return [[float(x) for x in line.split()[1:4]] for line in file if line.startswith("v ")]


a, b = (vertices(path) for path in sys.argv[1:3])
if len(a) != len(b):
    sys.exit("%d and %d vertices" % (len(a), len(b)))
largest = max(sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5 for p, q in zip(a, b))
print(largest)
sys.exit(0 if largest <= float(sys.argv[3]) else 1)
