#!/usr/bin/python3
"""Writes a straight tube of 8 mm diameter and 160 mm length, open at both ends, in millimetres: make_tube.py FILE.obj"""
import math
import sys

AROUND, ALONG = 24, 40

with open(sys.argv[1], "w") as out:
    for row in range(ALONG + 1):
        for k in range(AROUND):
            angle = 2 * math.pi * k / AROUND
            print("v", 4 * math.cos(angle), 4 * math.sin(angle), 160 * row / ALONG, file=out)
    for row in range(ALONG):
        for k in range(AROUND):
            a, b = row * AROUND + k + 1, row * AROUND + (k + 1) % AROUND + 1
            print("f", a, b, b + AROUND, a + AROUND, file=out)
