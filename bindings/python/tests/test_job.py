"""Progress, cancelling, threads, Ctrl-C."""

import signal
import subprocess
import sys
import threading
import time
import unittest

import welt
from test_mesh import CHAIR, cube, sheet


class Jobs(unittest.TestCase):
    def test_progress(self):
        seen = []
        refined = cube().refine(6, job=welt.Job(lambda done, stage: seen.append((done, stage))))
        self.assertEqual(refined.face_count(6), 6 * 4**6)
        self.assertEqual(seen[-1], (1.0, "done"))
        self.assertTrue(all(0 <= done <= 1 for done, _ in seen))
        self.assertEqual([done for done, _ in seen], sorted(done for done, _ in seen))

    def test_cancelled_before_and_meanwhile(self):
        mesh = welt.Mesh.read(CHAIR)
        before = mesh.positions.tolist()
        job = welt.Job()
        job.cancel()
        with self.assertRaises(welt.CancelledError):
            mesh.apply(mesh.select("ring:3,331"), "groove", job=job)
        job = welt.Job()
        timer = threading.Timer(0.2, job.cancel)
        timer.start()
        with self.assertRaises(welt.CancelledError):
            mesh.deviation(mesh.copy(), 64, job=job)
        timer.join()
        self.assertEqual(mesh.positions.tolist(), before)

    def test_what_an_observer_raises_comes_out(self):
        def observer(done, stage):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            mesh = welt.Mesh.read(CHAIR)
            mesh.deviation(mesh.copy(), 64, job=welt.Job(observer))

    def test_a_mesh_in_use_is_not_changed(self):
        mesh = welt.Mesh.read(CHAIR)
        positions = mesh.positions
        caught = []

        def observer(done, stage):
            try:
                mesh.positions = positions
            except welt.ArgumentError as error:
                caught.append(str(error))
                raise

        with self.assertRaises(welt.ArgumentError):
            mesh.deviation(mesh.copy(), 64, job=welt.Job(observer))
        self.assertIn("is used by another call", caught[0])
        mesh.positions = positions

    def test_calls_from_other_threads(self):
        results = []
        mesh = sheet(6)
        threads = [threading.Thread(target=lambda: results.append(mesh.refine(3).vertex_count(3))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(results, [49 * 49] * 4)

    @unittest.skipIf(sys.platform == "win32", "skipped: signals are sent another way on Windows")
    def test_ctrl_c_cancels(self):
        program = (
            "import signal, sys, welt\n"
            # Programs in the background start with it ignored.
            "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
            "mesh = welt.Mesh.read(sys.argv[1])\n"
            "print('started', flush=True)\n"
            "try:\n"
            "    mesh.deviation(mesh.copy(), 64)\n"
            "except KeyboardInterrupt:\n"
            "    print('interrupted', mesh.vertex_count)\n"
        )
        child = subprocess.Popen([sys.executable, "-c", program, CHAIR], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "started\n")
        time.sleep(0.2)
        start = time.monotonic()
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=60)
        self.assertLess(time.monotonic() - start, 5)
        self.assertEqual((out, err), (f"interrupted {welt.Mesh.read(CHAIR).vertex_count}\n", ""))


if __name__ == "__main__":
    unittest.main()
