"""Contrast medium in Python."""

import math
import pickle
import unittest

import numpy as np
import support
from support import evs


def patient(**overrides):
    return evs.World(support.REPOSITORY / "test/data/catheter_in_flow.yaml", contrast={}, **overrides)


class Contrast(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = patient()

    def test_is_injected_and_conserved(self):
        session = self.world.session()
        self.assertEqual(session.contrast.volume, 0.0)
        self.assertEqual(session.contrast.syringe, 12e-6)
        self.assertEqual(session.contrast.cells.size, 0)
        session.inject(volume=4e-6, rate=4e-6)
        session.step(n=600)
        contrast = session.contrast
        self.assertAlmostEqual(contrast.rate, 4e-6, 15)
        self.assertGreater(contrast.cells.max(), 50.0)
        self.assertLessEqual(contrast.cells.max(), 350.0 * (1 + 1e-9))
        self.assertAlmostEqual(contrast.volume + contrast.remaining, 4e-6, 15)
        self.assertAlmostEqual(contrast.inside + contrast.left, contrast.injected, 13)
        np.testing.assert_array_equal(contrast.instruments, [350.0])
        self.assertIn("ml injected", repr(contrast))
        session.stop_injection()
        session.step(n=10)
        self.assertEqual(session.contrast.remaining, 0.0)
        self.assertLess(session.contrast.syringe, 12e-6)
        session.refill_syringe()
        self.assertEqual(session.contrast.syringe, 12e-6)
        self.assertEqual(session.observe().contrast.volume, session.contrast.volume)

    def test_goes_on_in_copies_bit_for_bit(self):
        session = self.world.session()
        session.inject(3e-6, 4e-6, rise=0.1, concentration=300.0)
        session.step(n=303)
        copies = session.copy(), pickle.loads(pickle.dumps(session))
        session.step(n=400)
        for copy in copies:
            copy.step(n=400)
            np.testing.assert_array_equal(copy.contrast.cells, session.contrast.cells)
            self.assertEqual(copy.contrast.volume, session.contrast.volume)
            self.assertEqual(copy.state_hash, session.state_hash)
        self.assertLessEqual(session.contrast.cells.max(), 300.0 * (1 + 1e-9))

    def test_refuses_what_is_impossible(self):
        session = self.world.session()
        for wrong, text in (((-1e-6, 4e-6), "volume"), ((math.inf, 4e-6), "volume"), ((13e-6, 4e-6), "syringe holds 12 ml"),
                            ((6e-6, 0.0), "rate"), ((6e-6, math.nan), "rate"), ((6e-6, 4e-6, -1.0), "rise"),
                            ((6e-6, 4e-6, 0.3, 500.0), "concentration")):
            with self.assertRaisesRegex(evs.InputError, text):
                session.inject(*wrong)
        self.assertEqual(session.contrast.remaining, 0.0)
        session.inject(6e-6, 4e-6)
        with self.assertRaisesRegex(evs.InputError, "present injection"):
            session.inject(1e-6, 4e-6)
        tube = support.tube().session()
        self.assertIsNone(tube.contrast)
        for call in (lambda: tube.inject(1e-6, 1e-6), tube.stop_injection, tube.refill_syringe):
            with self.assertRaisesRegex(evs.UsageError, "contrast"):
                call()


if __name__ == "__main__":
    unittest.main()
