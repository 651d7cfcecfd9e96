"""The program `brinell` as a user meets it: arguments, messages, exit statuses, files.

Needs only Python's standard library. The program's path comes from the variable BRINELL_PROGRAM.
"""

import array
import json
import os
import pathlib
import pty
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree

PROGRAM = os.environ["BRINELL_PROGRAM"]
SUBCOMMANDS = ["run", "plan", "check", "resume", "report", "bench", "info"]

SCENE = """title = "Sphere"
[grid]
nodes = [32, 24]
spacing = [1e-6, 1.5e-6]
[lower]
youngs_modulus = 210e9
poissons_ratio = 0.3
[upper]
rigid = true
[[surface]]
shape = "sphere"
radius = 1e-3
[[step]]
normal_force = 0.05
increments = 3
[[step]]
approach = 1e-8
increments = 2
[output]
fields = ["pressure", "gap", "displacement"]
increments = "all"
"""

SUMMARY_KEYS = {"title", "converged", "version", "engine", "plan", "increments", "wall_seconds", "stage_seconds"}
INCREMENT_KEYS = {
    "step", "increment", "normal_force", "approach", "tilt", "centre_of_force", "first_touch", "contact_area",
    "contact_nodes", "offset", "max_pressure", "max_pressure_at", "mean_gap", "max_von_mises", "max_von_mises_at",
    "upper_max_von_mises", "upper_max_von_mises_at", "max_equivalent_plastic_strain", "max_equivalent_plastic_strain_at",
    "plastic_nodes", "iterations",
    "convolutions", "certificate", "wall_seconds"}


def gsf(nx, ny, heights, spacing=(1e-6, 1.5e-6)):
    header = (f"Gwyddion Simple Field 1.0\nXRes = {nx}\nYRes = {ny}\nXReal = {nx * spacing[0]}\n"
              f"YReal = {ny * spacing[1]}\nXYUnits = m\nZUnits = m\n").encode()
    return header + b"\0" * (4 - len(header) % 4) + array.array("f", heights).tobytes()


def without_times(summary):
    """A summary without what may differ from one run to the next."""
    increments = [{k: v for k, v in i.items() if k != "wall_seconds"} for i in summary["increments"]]
    return {"title": summary["title"], "converged": summary["converged"], "increments": increments}


class CommandLine(unittest.TestCase):

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="brinell_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.scene = self.write("scene.toml", SCENE)
        self.out = self.folder / "results"

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def brinell(self, *arguments, **options):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder,
                              timeout=300, **options)

    def run_scene(self, *arguments, **options):
        return self.brinell("run", self.scene, "--out", self.out, *arguments, **options)

    def expect(self, result, status, *words):
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    # ------------------------------------------------------------------ arguments

    def test_help_and_version_are_everywhere(self):
        for command in [[], *([name] for name in SUBCOMMANDS)]:
            for flag, word in (("--help", "Usage"), ("--version", "brinell ")):
                result = self.brinell(*command, flag)
                self.expect(result, 0)
                self.assertIn(word, result.stdout)
        for name in SUBCOMMANDS:
            self.assertIn(name, self.brinell("--help").stdout)

    def test_bad_usage_is_status_2(self):
        for arguments in ([], ["run"], ["walk"], ["run", "a", "b"], ["run", "a", "--outt", "b"], ["plan"],
                          ["run", "a", "--threads", "-1"], ["run", "a", "--threads", "many"], ["resume"],
                          ["bench", "--rounds", "-1"]):
            result = self.brinell(*arguments)
            self.expect(result, 2)
            self.assertTrue(result.stderr, arguments)

    def test_bad_usage_is_named(self):
        for arguments, words in ((["runn", "a"], ["brinell: 'runn'", "nearest is 'run'", "report"]),
                                 (["run"], ["brinell run: SCENE is required", "brinell run --help"]),
                                 (["plan", "a", "--jsn"], ["brinell plan: ", "--jsn"]),
                                 (["run", ""], ["SCENE", "empty"]), (["resume", ""], ["DIR", "empty"]),
                                 (["run", self.scene, "--out", ""], ["--out", "empty"])):
            self.expect(self.brinell(*arguments), 2, *words)
        self.assertIn("Subcommands", self.brinell().stderr)
        self.assertFalse((self.folder / "out").exists())

    # ------------------------------------------------------------------ results

    def test_run_writes_the_files_of_the_contract(self):
        result = self.run_scene()
        self.expect(result, 0)
        self.assertEqual(result.stderr, "")
        self.assertIn("results in", result.stdout)
        self.assertEqual(sorted(p.name for p in self.out.iterdir()),
                         ["checkpoint.bin", "fields.h5", "fields.xdmf", "run.json", "scene.toml", "summary.json",
                          "trace.csv"])
        self.assertEqual((self.out / "scene.toml").read_text(), SCENE)
        self.assertEqual((self.out / "fields.h5").read_bytes()[:8], b"\x89HDF\r\n\x1a\n")
        self.assertEqual((self.out / "trace.csv").read_text().splitlines()[0],
                         "step,increment,iteration,nx,ny,certified,seconds,certificate")

    def test_summary_has_the_keys_of_the_contract(self):
        result = self.run_scene("--json")
        self.expect(result, 0)
        summary = json.loads(result.stdout)
        self.assertEqual(summary, self.summary())
        self.assertLessEqual(SUMMARY_KEYS, set(summary))
        self.assertTrue(summary["converged"])
        self.assertEqual(set(summary["engine"]), {"isa", "threads", "precision"})
        self.assertEqual([(i["step"], i["increment"]) for i in summary["increments"]],
                         [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1)])
        for increment in summary["increments"]:
            self.assertLessEqual(INCREMENT_KEYS, set(increment))
            certificate = increment["certificate"]
            self.assertLessEqual({"penetration", "complementarity", "balance", "yield"}, set(certificate))
            self.assertIsNone(certificate["yield"])
            self.assertIsNone(increment["increment_error"])
            for part in ("penetration", "complementarity", "balance"):
                self.assertLessEqual(certificate[part], 1e-8)

    def test_xdmf_names_its_neighbour_and_every_stored_increment(self):
        self.expect(self.run_scene(), 0)
        root = xml.etree.ElementTree.parse(self.out / "fields.xdmf").getroot()
        items = [item.text for item in root.iter("DataItem") if item.get("Format") == "HDF"]
        self.assertEqual(len(items), 5 * 3)
        self.assertTrue(all(item.startswith("fields.h5:/step_") for item in items))
        self.assertEqual([t.get("Value") for t in root.iter("Time")], ["1", "2", "3", "4", "5"])

    def test_output_increments_select_what_is_stored(self):
        for choice, stored in (("last", 1), ("steps", 2), ("all", 5)):
            self.write("scene.toml", SCENE.replace('increments = "all"', f'increments = "{choice}"'))
            self.expect(self.run_scene(), 0)
            self.assertEqual((self.out / "fields.xdmf").read_text().count("<Time"), stored)
        self.write("scene.toml", SCENE.replace('["pressure", "gap", "displacement"]', "[]"))
        self.expect(self.run_scene(), 0)
        self.assertFalse((self.out / "fields.h5").exists())

    def test_a_folder_is_a_scene_and_gives_its_name_to_the_results(self):
        folder = self.folder / "sphere_case"
        folder.mkdir()
        shutil.copy(self.scene, folder)
        self.expect(self.brinell("run", folder, "--quiet"), 0)
        self.assertTrue((self.folder / "out" / "sphere_case" / "summary.json").exists())

    def test_a_contact_that_fills_the_edge_of_the_grid_is_told_once(self):
        self.write("scene.toml", SCENE.replace("210e9", "210"))  # GPa instead of Pa
        result = self.run_scene()
        self.expect(result, 0, "brinell: warning: step 0, increment 0", "108 of 108 nodes on the edge", "Pa")
        self.assertEqual(result.stderr.count("\n"), 1)
        self.write("scene.toml", SCENE.replace("210e9", "210").replace("[lower]", 'boundary = "periodic"\n[lower]')
                   .replace("approach = 1e-8", "normal_force = 0"))
        result = self.run_scene()
        self.expect(result, 0)
        self.assertEqual(result.stderr, "")

    def test_quiet_prints_nothing(self):
        result = self.run_scene("--quiet")
        self.expect(result, 0)
        self.assertEqual(result.stdout + result.stderr, "")

    def test_threads_do_not_change_a_bit(self):
        fields = []
        for threads in (1, 2, 3):
            self.expect(self.run_scene("--threads", threads), 0)
            fields.append((self.out / "fields.h5").read_bytes())
        self.assertEqual(fields[0], fields[1])
        self.assertEqual(fields[0], fields[2])

    def test_plan_check_and_info_answer(self):
        plan = json.loads(self.brinell("plan", self.scene, "--json").stdout)
        self.assertEqual(plan["nodes"], [32, 24])
        self.assertIn("contact", plan["stages"])
        self.assertGreater(plan["memory_bytes"], 32 * 24 * 8)
        self.assertIn("contact", self.brinell("plan", self.scene).stdout)
        self.assertIn("5 increments in 2 steps", self.brinell("plan", self.scene).stdout)
        self.assertIn("valid", self.brinell("check", self.scene).stdout)
        self.assertIn("isa", json.loads(self.brinell("info", "--json").stdout))
        self.write("map.gsf", gsf(2, 2, [0, 1, 2, 3]))
        self.assertEqual(json.loads(self.brinell("info", "map.gsf", "--json").stdout)[0]["nodes"], [2, 2])

    def test_bench_times_scenes_without_writing(self):
        before = sorted(self.folder.iterdir())
        result = json.loads(self.brinell("bench", self.scene, "--rounds", 2, "--no-instructions", "--json").stdout)
        self.assertEqual([s["increments"] for s in result["scenes"]], [5])
        figure = result["scenes"][0]["figures"][0]
        self.assertGreater(figure["median_seconds"], 0)
        self.assertEqual(figure["not_compared"], "no baseline")
        self.assertEqual(sorted(self.folder.iterdir()), before)
        self.expect(self.brinell("bench"), 3, "profiles/")

    def test_bench_fails_only_beyond_what_is_allowed(self):
        bench = ["bench", self.scene, "--no-instructions", "--rounds", 2, "--baselines", "kept"]
        self.expect(self.brinell(*bench, "--update"), 0)
        kept = self.folder / "kept" / self.folder.name / "baseline.json"
        self.expect(self.brinell(*bench, "--allowed", 1000), 0)
        baseline = json.loads(kept.read_text())
        self.assertEqual(baseline["figures"]["time"]["calibration"], "calibration_transforms")
        baseline["figures"]["time"]["ratio"] /= 1e6
        kept.write_text(json.dumps(baseline))
        self.expect(self.brinell(*bench, "--allowed", 1000), 1, "time costs", baseline["recorded"]["date"])
        baseline["recorded"]["machine"] = "an abacus"
        kept.write_text(json.dumps(baseline))
        self.assertIn("recorded on an abacus", self.brinell(*bench).stdout)
        kept.write_text("{}")
        self.expect(self.brinell(*bench), 3, "is no baseline")

    @unittest.skipUnless(shutil.which("valgrind"), "valgrind is not installed")
    @unittest.skipIf(os.environ.get("BRINELL_SANITIZE"), "valgrind runs no sanitized programs")
    def test_bench_counts_instructions_that_repeat(self):
        bench = ["bench", self.scene, "--rounds", 0, "--baselines", "kept"]
        self.expect(self.brinell(*bench, "--update"), 0)
        again = json.loads(self.brinell(*bench, "--json").stdout)["scenes"][0]["figures"][0]
        self.assertEqual(again["name"], "instructions")
        self.assertAlmostEqual(again["against_baseline"], 1, delta=0.001)

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_report_draws_pictures(self):
        self.expect(self.run_scene(), 0)
        self.expect(self.brinell("report", self.out), 0)
        for name in ("trace", "history", "pressure"):
            self.assertEqual((self.out / f"{name}.png").read_bytes()[:4], b"\x89PNG")
            xml.etree.ElementTree.parse(self.out / f"{name}.svg")

    def test_report_without_gnuplot_names_it(self):
        self.expect(self.run_scene(), 0)
        self.expect(self.brinell("report", self.out, env={**os.environ, "PATH": str(self.folder)}), 3, "gnuplot")

    # ------------------------------------------------------------------ bodies that tilt

    def tilt_scene(self, *steps, grid=""):
        """A flat punch of 10 um radius with a rounded edge on steel."""
        text = "".join(f"[[step]]\n{step}\n" for step in steps)
        return self.write("scene.toml", f"""title = "Tilt"
[grid]
nodes = [48, 40]
spacing = [0.7e-6, 0.8e-6]
{grid}
[lower]
youngs_modulus = 210e9
poissons_ratio = 0.3
[upper]
rigid = true
[[surface]]
shape = "flat_punch"
radius = 10e-6
edge_radius = 1e-3
{text}[output]
fields = ["pressure", "gap"]
increments = "all"
""")

    def test_eccentricity_tilts_and_tilt_gives_it_back(self):
        self.tilt_scene("normal_force = 0.02", "normal_force = 0.02\neccentricity = [3e-6, -1e-6]")
        self.expect(self.run_scene(), 0)
        parallel, eccentric = self.summary()["increments"]
        self.assertEqual(parallel["tilt"], [0, 0])
        # half the grid is 16.8 and 16 um, and the certificate 1e-8 of that
        for found, wanted in zip(eccentric["centre_of_force"], (3e-6, -1e-6)):
            self.assertAlmostEqual(found, wanted, delta=1.7e-13)
        self.assertLess(eccentric["tilt"][0], -1e-5)
        self.assertGreater(eccentric["tilt"][1], 1e-6)
        self.assertLess(max(eccentric["certificate"][part] for part in ("penetration", "balance")), 1e-8)

        self.tilt_scene("normal_force = 0.02\ntilt = [{!r}, {!r}]".format(*eccentric["tilt"]))
        self.expect(self.run_scene(), 0)
        given = self.summary()["increments"][0]
        self.assertEqual(given["tilt"], eccentric["tilt"])
        for found, wanted in zip(given["centre_of_force"], eccentric["centre_of_force"]):
            self.assertAlmostEqual(found, wanted, delta=1e-12)
        self.assertAlmostEqual(given["approach"] / eccentric["approach"], 1, delta=1e-7)

    def test_bad_eccentricity_and_tilt_are_status_2(self):
        force = "normal_force = 0.02\n"
        cases = [
            ("eccentricity = [1e-6, 0]\ntilt = [0, 0]", "", ["[[step]] 1", "tilt", "either eccentricity or tilt"]),
            ("eccentricity = [17e-6, 0]", "", [":15: [[step]] 1", "eccentricity", "1.7e-05", "outside the grid"]),
            ("eccentricity = [0, -16e-6]", "", ["eccentricity", "-1.6e-05", "outside the grid"]),
            ("eccentricity = [1e-6, 0]", 'boundary = "periodic"', [":15: [[step]] 1", "eccentricity", "boundary = \"free\""]),
            ("tilt = [1e-6, 0]", 'boundary = "periodic"', [":15: [[step]] 1", "tilt", "boundary = \"free\""]),
            ("eccentricity = 1e-6", "", ["[[step]] 1", "eccentricity = ", "[x, y]"]),
            ("eccentricity = [1e-6]", "", ["[[step]] 1", "eccentricity", "found 1 value"]),
            ("eccentricity = [1e-6, 'left']", "", ["[[step]] 1", "eccentricity", "number"]),
            ("eccentricity = [nan, 0]", "", ["[[step]] 1", "eccentricity", "finite"]),
            ("tilt = [0, 0, 1e-6]", "", ["[[step]] 1", "tilt", "found 3 values"]),
            ("tilt = [0, inf]", "", ["[[step]] 1", "tilt", "finite"]),
            ("excentricity = [1e-6, 0]", "", ["'excentricity'", "'eccentricity'"]),
        ]
        for step, grid, words in cases:
            with self.subTest(step + grid):
                self.tilt_scene(force + step, grid=grid)
                for result in (self.run_scene(), self.brinell("check", self.scene)):
                    self.expect(result, 2, "brinell: ", "scene.toml", *words)
                    self.assertEqual(result.stdout, "")
                self.assertFalse(self.out.exists())

    # ------------------------------------------------------------------ an upper body that moves

    def test_offsets_move_the_upper_body_and_add_up(self):
        self.tilt_scene("normal_force = 0.02", "normal_force = 0.02\noffset = [2.1e-6, -1.6e-6]",
                        "normal_force = 0.01\noffset = [-0.35e-6, 0]",
                        "normal_force = 0.02\noffset = [-1.75e-6, 1.6e-6]")
        self.expect(self.run_scene(), 0)
        increments = self.summary()["increments"]
        self.assertEqual(increments[0]["offset"], [0, 0])
        self.assertEqual(increments[3]["offset"], [0, 0])
        for found, wanted in zip(increments[2]["offset"], (1.75e-6, -1.6e-6)):
            self.assertAlmostEqual(found, wanted, delta=1e-20)
        for increment in increments:
            for found, wanted in zip(increment["centre_of_force"], increment["offset"]):
                self.assertAlmostEqual(found, wanted, delta=2e-8)  # a flat edge between nodes: a part of a cell
        self.expect(self.brinell("check", self.scene), 0)
        plan = self.brinell("plan", self.scene)
        self.expect(plan, 0)
        self.assertIn("gap before the upper body moves", plan.stdout)

    def test_bad_offsets_and_bodies_are_status_2(self):
        cases = [
            ("offset = 1e-6", "", ["[[step]] 1", "offset = ", "[x, y]"]),
            ("offset = [1e-6]", "", ["[[step]] 1", "offset", "found 1 value"]),
            ("offset = [nan, 0]", "", ["[[step]] 1", "offset", "finite"]),
            ("ofset = [1e-6, 0]", "", ["'ofset'", "'offset'"]),
            ("offset = [1e-6, 0]", 'shape = "rough"\nhurst = 0.8\nrms_slope = 0.1\nbody = "upper"',
             ["offset", "rough", "multiples of the spacing, 7e-07 x 8e-07 m"]),
            ("offset = [1e-6, 0]", 'shape = "plane"\nbody = "both"', ["[[surface]] 2", "body", "lower, upper"]),
        ]
        for step, surface, words in cases:
            with self.subTest(step + surface):
                more = "\n[[surface]]\n" + surface if surface else ""
                self.tilt_scene("normal_force = 0.02\n" + step + more)
                for result in (self.run_scene(), self.brinell("check", self.scene)):
                    self.expect(result, 2, "brinell: ", *words)
                    self.assertEqual(result.stdout, "")
                self.assertFalse(self.out.exists())

    # ------------------------------------------------------------------ below the surface

    def below_scene(self, output, layers="layers = 20\nlayer_thickness = 0.7e-6", step="", upper="rigid = true"):
        """A sphere on steel: contact radius 14.8 um, peak pressure 2.18 GPa."""
        return self.write("scene.toml", f"""title = "Below"
[grid]
nodes = [64, 64]
spacing = [0.6e-6, 0.6e-6]
{layers}
[lower]
youngs_modulus = 210e9
poissons_ratio = 0.3
[upper]
{upper}
[[surface]]
shape = "sphere"
radius = 1e-3
[[step]]
normal_force = 1.0
increments = 2
{step}
[output]
{output}
""")

    def test_largest_von_mises_is_what_hertz_says(self):
        radius = (0.75 * 1e-3 * (1 - 0.09) / 210e9) ** (1 / 3)
        peak = 1.5 / (3.141592653589793 * radius**2)
        self.below_scene('fields = ["von_mises", "stress"]', step="[[step]]\nnormal_force = 1.0\ntraction_ratio = [0.5, 0]")
        self.expect(self.run_scene(), 0)
        summary = self.summary()
        self.assertEqual(summary["plan"]["stages"], ["surface", "contact", "stress"])
        self.assertGreater(summary["stage_seconds"]["stress"], 0)
        _, pressed, sliding = summary["increments"]
        # 25 cells across the contact radius: within a few tenths of a percent
        self.assertAlmostEqual(pressed["max_von_mises"] / peak, 0.620041, delta=0.002)
        self.assertAlmostEqual(pressed["max_von_mises_at"][2] / radius, 0.48086, delta=0.005)
        self.assertIsNone(pressed["upper_max_von_mises"])
        self.assertGreater(sliding["max_von_mises"], 1.2 * pressed["max_von_mises"])
        self.assertLess(sliding["max_von_mises_at"][2], 0.1 * radius)
        # The same pressure, scaled to the same force once more: rounding.
        self.assertAlmostEqual(sliding["max_pressure"] / pressed["max_pressure"], 1, delta=1e-14)

    def test_no_layers_no_stress(self):
        self.below_scene('fields = ["pressure"]')  # layers alone ask for nothing
        self.expect(self.run_scene(), 0)
        summary = self.summary()
        self.assertEqual(summary["plan"]["stages"], ["surface", "contact"])
        self.assertNotIn("stress", summary["stage_seconds"])
        for key in ("max_von_mises", "max_von_mises_at", "upper_max_von_mises", "upper_max_von_mises_at"):
            self.assertIsNone(summary["increments"][-1][key])
        bare = summary["plan"]["memory_bytes"]
        self.below_scene('fields = ["pressure"]', layers="")
        self.assertEqual(json.loads(self.brinell("plan", self.scene, "--json").stdout)["memory_bytes"], bare)

    def test_the_largest_alone_stores_no_field(self):
        both = "youngs_modulus = 70e9\npoissons_ratio = 0.2"
        self.below_scene('fields = []\nmaxima = ["von_mises", "upper_von_mises"]', upper=both,
                         layers="layer_depths = [0, 2e-6, 5e-6, 9e-6]")
        plan = json.loads(self.brinell("plan", self.scene, "--json").stdout)
        self.assertFalse([item for item in plan["items"] if item["what"].startswith("field")])
        self.expect(self.run_scene(), 0)
        last = self.summary()["increments"][-1]
        self.assertGreater(last["max_von_mises"], 0)
        self.assertGreater(last["upper_max_von_mises"], 0)
        self.assertNotEqual(last["max_von_mises"], last["upper_max_von_mises"])
        self.assertFalse((self.out / "fields.h5").exists())

    def test_fields_below_the_surface_are_in_the_file_with_their_depths(self):
        both = "same_as_lower = true"
        self.below_scene('fields = ["pressure", "stress", "upper_von_mises", "hydrostatic", "principal_directions"]',
                         upper=both,
                         layers="layer_depths = [0, 2e-6, 5e-6]")
        self.expect(self.run_scene(), 0)
        tree = xml.etree.ElementTree.parse(self.out / "fields.xdmf")
        names = {a.get("Name") for a in tree.iter("Attribute")}
        self.assertLessEqual({"pressure", "stress_xx", "stress_xy", "upper_von_mises", "hydrostatic", "principal_directions_1",
                              "principal_directions_3"}, names)
        sizes = {d.text.split(":")[1].rsplit("/", 1)[1]: d.get("Dimensions") for d in tree.iter("DataItem")
                 if d.get("Format") == "HDF"}
        self.assertEqual(sizes["stress"], "3 64 64 6")
        self.assertEqual(sizes["principal_directions"], "3 64 64 9")
        self.assertEqual(sizes["upper_von_mises"], "3 64 64")
        self.assertEqual(sizes["pressure"], "1 64 64")
        self.assertIn("0 2e-06 5e-06", [d.text for d in tree.iter("DataItem")])
        if shutil.which("h5dump"):
            dump = subprocess.run(["h5dump", "-a", "/depths", self.out / "fields.h5"], capture_output=True, text=True)
            self.assertIn("0, 2e-06, 5e-06", dump.stdout)

    def test_threads_do_not_change_a_bit_below_the_surface(self):
        self.below_scene('fields = ["stress", "principal_1"]', step="traction_ratio = [0.2, 0.1]")
        fields = []
        for threads in (1, 2, 8):
            self.expect(self.run_scene("--threads", threads), 0)
            fields.append((self.out / "fields.h5").read_bytes())
        self.assertEqual(fields[0], fields[1])
        self.assertEqual(fields[0], fields[2])

    def test_resume_makes_the_stress_anew_to_the_same_bits(self):
        self.below_scene('fields = ["stress"]')
        self.expect(self.run_scene(), 0)
        before = self.summary()
        fields = (self.out / "fields.h5").read_bytes()
        self.expect(self.brinell("resume", self.out), 0)
        self.assertEqual(without_times(self.summary()), without_times(before))
        self.assertEqual((self.out / "fields.h5").read_bytes(), fields)

    def test_bad_requests_below_the_surface_are_told_with_their_line(self):
        fields = 'fields = ["stress"]'
        layers = "layers = 20\nlayer_thickness = 0.7e-6"
        cases = [
            (fields, "layers = 20", "", ["scene.toml:2: [grid]", "layer_thickness is missing"]),
            (fields, "layer_thickness = 1e-6", "", [":2: [grid]", "layers is missing", "field stress"]),
            (fields, "", "", [":2: [grid]", "layer_depths"]),
            (fields, "layer_depths = [0, -1e-6]", "", [":5: [grid]", "layer_depths", "at least 0"]),
            (fields, "layer_depths = [2e-6, 1e-6]", "", [":5: [grid]", "increasing"]),
            (fields, "layer_depths = [1e-6]\nlayers = 3", "", [":5: [grid]", "either"]),
            ('fields = ["von_misses"]', layers, "", ["'von_misses'", "'von_mises'"]),
            ('maxima = ["tresca"]', layers, "", ["maxima", "von_mises"]),
            ('maxima = ["von_mises"]', "", "", ["[grid]", "the largest von_mises"]),
            ('fields = ["upper_stress"]', layers, "", ["[output]", "upper", "rigid"]),
            (fields, layers, "traction_ratio = 0.3", ["[[step]] 1", "traction_ratio"]),
            (fields, layers, "traction_ratio = [nan, 0]", ["[[step]] 1", "traction_ratio"]),
        ]
        for output, grid, step, words in cases:
            with self.subTest(output + grid + step):
                self.below_scene(output, grid, step)
                for result in (self.run_scene(), self.brinell("check", self.scene)):
                    self.expect(result, 2, "brinell: ", "scene.toml", *words)
                self.assertFalse(self.out.exists())

    # ------------------------------------------------------------------ bodies that harden

    def hardening_scene(self, old="", new=""):
        """A sphere on soft steel, loaded and unloaded: contact radius 15 um."""
        text = """title = "Imprint"
[grid]
nodes = [24, 24]
spacing = [2e-6, 2e-6]
layers = 14
layer_thickness = 2.5e-6
[lower]
youngs_modulus = 210e9
poissons_ratio = 0.3
[lower.hardening]
law = "linear"
yield_stress = 800e6
hardening_modulus = 5e9
[upper]
rigid = true
[[surface]]
shape = "sphere"
radius = 1e-3
[[step]]
normal_force = 1.0
increments = 3
[[step]]
normal_force = 0.0
[solver]
tolerance = 1e-7
[output]
fields = ["plastic_strain", "equivalent_plastic_strain", "residual_stress", "residual_displacement", "von_mises"]
"""
        self.assertIn(old, text)
        return self.write("scene.toml", text.replace(old, new, 1))

    def test_a_body_that_hardens_keeps_an_imprint(self):
        self.hardening_scene()
        self.expect(self.run_scene(), 0)
        summary = self.summary()
        self.assertEqual(set(summary["plan"]["stages"]), {"surface", "contact", "stress", "plastic"})
        self.assertGreater(summary["stage_seconds"]["plastic"], 0)
        loaded, apart = summary["increments"][-2:]
        self.assertGreater(loaded["plastic_nodes"], 100)
        self.assertGreater(loaded["max_equivalent_plastic_strain"], 1e-4)
        self.assertEqual(len(loaded["max_equivalent_plastic_strain_at"]), 3)
        self.assertIsNone(loaded["upper_max_equivalent_plastic_strain"])
        self.assertEqual(apart["contact_nodes"], 0)
        self.assertGreater(apart["approach"], 0)
        for increment in summary["increments"]:
            self.assertLessEqual(increment["certificate"]["yield"], 1e-7)
            self.assertEqual(increment["substeps"], 1)
        self.assertGreater(loaded["increment_error"], 0)
        self.assertEqual(apart["increment_error"], 0)
        tree = xml.etree.ElementTree.parse(self.out / "fields.xdmf")
        sizes = {d.text.split(":")[1].rsplit("/", 1)[1]: d.get("Dimensions") for d in tree.iter("DataItem")
                 if d.get("Format") == "HDF"}
        self.assertEqual(sizes["plastic_strain"], "14 24 24 6")
        self.assertEqual(sizes["residual_stress"], "14 24 24 6")
        self.assertEqual(sizes["equivalent_plastic_strain"], "14 24 24")
        self.assertEqual(sizes["residual_displacement"], "1 24 24")

    def test_a_body_that_hardens_is_pressed_elsewhere_and_slid_on(self):
        self.hardening_scene("normal_force = 0.0\n", "normal_force = 0.0\n[[step]]\nnormal_force = 1.0\n"
                             "offset = [4e-6, 0]\ntraction_ratio = [0, 0.3]\n")
        self.expect(self.run_scene(), 0)
        increments = self.summary()["increments"]
        once, again = increments[-3], increments[-1]
        self.assertEqual(again["offset"], [4e-6, 0])
        self.assertGreater(again["plastic_nodes"], 1.1 * once["plastic_nodes"])
        self.assertGreater(again["centre_of_force"][0], 3e-6)
        self.assertGreater(again["first_touch"], 0)  # the imprints
        self.assertLessEqual(again["certificate"]["yield"], 1e-7)

    def test_identical_bodies_harden_alike(self):
        self.hardening_scene("[upper]\nrigid = true", "[upper]\nsame_as_lower = true")
        self.expect(self.run_scene(), 0)
        last = self.summary()["increments"][-1]
        self.assertGreater(last["max_equivalent_plastic_strain"], 0)
        self.assertEqual(last["upper_max_equivalent_plastic_strain"], last["max_equivalent_plastic_strain"])

    def test_bodies_that_cannot_harden_are_told_with_their_line(self):
        cases = [
            ("layers = 14\nlayer_thickness = 2.5e-6\n", "", [":2: [grid]", "layers"]),
            ("hardening_modulus = 5e9\n", "", ["[lower.hardening]", "hardening_modulus is missing"]),
            ("yield_stress = 800e6", "yield_stress = 0.0", ["yield_stress"]),
            ('"von_mises"]', '"upper_plastic_strain"]', ["upper_plastic_strain", "[upper.hardening]"]),
            ("nodes = [24, 24]", 'nodes = [24, 24]\nboundary = "periodic"', ["free boundary"]),
            ("[upper]\nrigid = true", "[upper]\nrigid = true\nhardening = {law = \"perfect\", yield_stress = 1e9}",
             ["hardening", "rigid = true"]),
            ("[upper]\nrigid = true", "[upper]\nsame_as_lower = true\n[[step]]\nnormal_force = 1.0\noffset = [2e-6, 0]",
             ["offset = [2e-06, 0]", "same_as_lower"]),
            ("[upper]\nrigid = true",
             "[upper]\nsame_as_lower = true\n[[step]]\nnormal_force = 1.0\ntraction_ratio = [0.1, 0]",
             ["traction_ratio = [0.1, 0]", "same_as_lower"]),
        ]
        for old, new, words in cases:
            with self.subTest(new):
                self.hardening_scene(old, new)
                self.expect(self.run_scene(), 2, "brinell: ", *words)
                self.assertFalse(self.out.exists())

    def test_plastic_strain_beyond_the_layers_stops_the_run(self):
        self.hardening_scene("layers = 14", "layers = 5")
        self.expect(self.run_scene(), 2, "last layer")
        self.assertLess(len(self.summary()["increments"]), 4)  # what was solved before is kept

    # ------------------------------------------------------------------ height maps

    def surface_scene(self, path, extra="", grid="nodes = [4, 3]\nspacing = [1e-6, 1.5e-6]"):
        text = SCENE.replace("nodes = [32, 24]\nspacing = [1e-6, 1.5e-6]", grid)
        return self.write("scene.toml", text.replace('shape = "sphere"\nradius = 1e-3',
                                                     f'shape = "file"\npath = "{path}"\n{extra}'))

    def test_paths_are_relative_to_the_scene(self):
        maps = self.folder / "maps"
        maps.mkdir()
        (maps / "map.gsf").write_bytes(gsf(4, 3, [1e-9 * k for k in range(12)]))
        scene = self.surface_scene("maps/map.gsf")
        result = subprocess.run([PROGRAM, "check", str(scene)], capture_output=True, text=True, cwd="/", timeout=60)
        self.expect(result, 0)

    def test_the_grid_may_come_from_the_file(self):
        self.write("map.gsf", gsf(4, 3, [1e-9 * k for k in range(12)]))
        self.surface_scene("map.gsf", grid="")
        plan = json.loads(self.brinell("plan", self.scene, "--json").stdout)
        self.assertEqual(plan["nodes"], [4, 3])
        self.assertAlmostEqual(plan["spacing"][1], 1.5e-6, delta=1e-12)
        self.write("map.txt", "1 2\n3 4\n")
        self.surface_scene("map.txt", grid="")
        self.expect(self.brinell("check", self.scene), 2, "spacing is missing")

    def test_a_map_that_does_not_fit_is_told_with_both_sizes(self):
        self.write("map.gsf", gsf(5, 3, [0] * 15))
        self.surface_scene("map.gsf")
        self.expect(self.run_scene(), 2, "scene.toml:10: [[surface]] 1", "5 x 3", "4 x 3")
        self.write("map.gsf", gsf(4, 3, [0] * 12, (2e-6, 1.5e-6)))
        self.expect(self.run_scene(), 2, "2e-06 x 1.5e-06", "1e-06 x 1.5e-06")
        self.assertFalse(self.out.exists())

    def test_a_scene_that_contradicts_its_file_is_status_2(self):
        self.write("map.gsf", gsf(4, 3, [0] * 12))
        for extra, words in (('units = "nm"', ["'nm'", "'m'", "leave units out"]),
                             ('dataset = "/heights"', ["not an HDF5 file", "/heights"])):
            self.surface_scene("map.gsf", extra)
            self.expect(self.run_scene(), 2, "scene.toml:10: [[surface]] 1", "map.gsf", *words)
            self.assertFalse(self.out.exists())

    def test_bad_maps_are_status_3(self):
        whole = gsf(4, 3, [0] * 12)
        cases = [
            ("none.gsf", None, ["none.gsf", "no such file"]),
            ("cut.gsf", whole[:-5], ["cut.gsf", "expected"]),
            ("empty.gsf", b"", ["empty.gsf", "is empty"]),
            ("text.gsf", b"1 2 3\n", ["text.gsf", "not a Gwyddion Simple Field"]),
            ("nan.gsf", gsf(4, 3, [0] * 6 + [float("nan")] + [0] * 5), ["1 of 12", "column 2, row 1"]),
            ("inf.gsf", gsf(4, 3, [float("inf")] + [0] * 11), ["inf", "column 0, row 0"]),
            ("noise.dat", bytes(range(256)), ["noise.dat", "not a text"]),
            ("words.txt", b"1 2 3 4\n1 2 3 x\n", ["words.txt", "line 2", "'x'"]),
            ("cut.npy", b"\x93NUMPY\x01\x00\x76\x00{'descr'", ["cut.npy", "header"]),
            ("cut.x3p", b"PK\x03\x04", ["cut.x3p", "zip"]),
            ("cut.h5", b"\x89HDF\r\n\x1a\n", ["cut.h5", "HDF5"]),
        ]
        for name, content, words in cases:
            with self.subTest(name):
                if content is not None:
                    self.write(name, content)
                self.surface_scene(name)
                self.expect(self.run_scene(), 3, *words)
                self.assertFalse(self.out.exists())

    def test_missing_heights_may_be_filled(self):
        self.write("nan.gsf", gsf(4, 3, [0] * 6 + [float("nan")] + [0] * 5))
        self.surface_scene("nan.gsf", "fill_missing = true")
        self.expect(self.brinell("check", self.scene), 0)

    # ------------------------------------------------------------------ bad scenes

    def test_bad_scenes_are_status_2_and_write_nothing(self):
        cases = [
            ("spacing =", "spaceing =", [":4: [grid]", "'spaceing'", "'spacing'"]),
            ("[output]", "[outputs]", [":19:", "'outputs'", "'output'"]),
            ("radius = 1e-3", 'radius = "large"', [":12: [[surface]] 1", "radius", "expected a number"]),
            ("normal_force = 0.05\n", "", [":13: [[step]] 1", "found none"]),
            ("normal_force = 0.05", "normal_force = 0.05\napproach = 0", ["[[step]] 1", "found 2"]),
            ("[1e-6, 1.5e-6]", "[0, 1.5e-6]", ["spacing", "above 0"]),
            ("[1e-6, 1.5e-6]", "[1e-6, -1]", ["spacing = [1e-06, -1]", "above 0"]),
            ("[1e-6, 1.5e-6]", "[1e-6, nan]", ["spacing = [1e-06, nan]", "finite"]),
            ("[1e-6, 1.5e-6]", "[1e-300, 1e-300]", ["spacing", "1e-300", "area of a cell"]),
            ("[32, 24]", "[32, 0]", ["nodes", "from 1"]),
            ("poissons_ratio = 0.3", "poissons_ratio = 0.5", ["poissons_ratio = 0.5", "below 0.5"]),
            ("poissons_ratio = 0.3", "poissons_ratio = -1.0", ["poissons_ratio = -1,", "above -1"]),
            ("210e9", "-210e9", ["youngs_modulus", "above 0"]),
            ("youngs_modulus = 210e9\npoissons_ratio = 0.3", "rigid = true", ["both bodies are rigid"]),
            ("normal_force = 0.05", "normal_force = -0.05", ["normal_force = -0.05", "at least 0"]),
            ("normal_force = 0.05", "mean_pressure = 1e6", ["mean_pressure", "periodic"]),
            ('"sphere"', '"spher"', ['"spher"', "'sphere'"]),
            ("radius = 1e-3", "", ["radius is missing"]),
            ('"gap"', '"gape"', ["'gape'", "'gap'"]),
            ("normal_force = 0.05", "force = 0.05", ["'force'", "nearest known key is 'normal_force'"]),
            ("[[surface]]", "[surface]", [":10: found [surface], expected [[surface]]"]),
            ("title =", "title", [":1:"]),
            ('shape = "sphere"\nradius = 1e-3', 'shape = "cone"\nhalf_angle = 2.0', ["[[surface]] 1", "half_angle"]),
        ]
        for old, new, words in cases:
            with self.subTest(new):
                self.assertIn(old, SCENE)
                self.write("scene.toml", SCENE.replace(old, new, 1))
                for result in (self.run_scene(), self.brinell("check", self.scene)):
                    self.expect(result, 2, "brinell: ", "scene.toml", *words)
                    self.assertEqual(result.stdout, "")
                self.assertFalse(self.out.exists())

    def test_a_scene_that_cannot_be_read_is_status_3(self):
        self.expect(self.brinell("run", self.folder / "none.toml"), 3, "none.toml", "no such file")
        (self.folder / "bare").mkdir()
        self.expect(self.brinell("run", self.folder / "bare"), 3, "scene.toml")
        self.assertFalse((self.folder / "out").exists())

    def test_a_grid_beyond_memory_is_refused_with_its_size(self):
        for nodes in ("[1000000, 1000000]", "[2147483647, 2147483647]"):
            self.write("scene.toml", SCENE.replace("[32, 24]", nodes))
            result = self.run_scene()
            self.expect(result, 3)
            self.assertRegex(result.stderr, r"[0-9]+")
            self.assertFalse(self.out.exists())

    # ------------------------------------------------------------------ trouble with files

    def test_an_output_folder_that_cannot_be_is_status_3(self):
        self.out = self.write("file", "") / "below"
        self.expect(self.run_scene(), 3, "file/below", "cannot be created")
        self.out = self.folder / "file"
        self.expect(self.run_scene(), 3, "file")
        self.assertEqual(self.out.read_bytes(), b"")

    def test_another_scene_is_not_overwritten(self):
        self.out.mkdir()
        (self.out / "scene.toml").write_text("precious")
        self.expect(self.run_scene(), 3, "another scene")
        self.assertEqual([p.read_text() for p in self.out.iterdir()], ["precious"])

    def test_results_that_no_run_has_written_are_not_replaced(self):
        for name in ("summary.json", "trace.csv", "fields.h5", "fields.xdmf", "checkpoint.bin"):
            with self.subTest(name):
                (self.folder / name).write_text("precious")
                self.expect(self.brinell("run", self.scene, "--out", "."), 3, name, "no run has written")
                self.assertEqual((self.folder / name).read_text(), "precious")
                (self.folder / name).unlink()
        for _ in range(2):  # the scene's own folder, new and again
            self.expect(self.brinell("run", self.scene, "--out", "."), 0)

    def test_a_full_disk_is_status_3_and_leaves_no_part(self):
        self.write("scene.toml", SCENE.replace("[32, 24]", "[64, 64]"))
        # ThreadSanitizer itself writes a file before main, which no limit of zero lets it.
        nothing = 1 if os.environ.get("BRINELL_SANITIZE") == "thread" else 0
        for limit in (nothing, 100, 1000, 5000, 50000):
            with self.subTest(limit):
                shutil.rmtree(self.out, ignore_errors=True)
                result = self.run_scene(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                self.expect(result, 3, str(self.out))
                left = [p.name for p in self.out.iterdir()] if self.out.exists() else []
                self.assertNotIn("summary.json", left)
                self.assertFalse([name for name in left if ".part" in name], left)

    def test_a_full_standard_output_is_status_3(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([PROGRAM, "info"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(result.returncode, 3)
        self.assertIn("standard output", result.stderr)

    # ------------------------------------------------------------------ convergence and interruption

    def test_a_run_that_does_not_converge_is_status_1_and_marked(self):
        self.write("scene.toml", SCENE + "[solver]\ntolerance = 1e-14\nmax_iterations = 1\n")
        self.expect(self.run_scene(), 1, "not converged")
        summary = self.summary()
        self.assertFalse(summary["converged"])
        self.assertFalse(summary["increments"][-1]["converged"])
        self.assertTrue((self.out / "fields.h5").exists())

    def interrupt_after_first_increment(self):
        """Starts a run on a terminal and stops it when its progress line tells of the second increment."""
        terminal, program_side = pty.openpty()
        process = subprocess.Popen([PROGRAM, "run", str(self.scene), "--out", str(self.out)], stderr=program_side,
                                   stdout=subprocess.DEVNULL, cwd=self.folder)
        os.close(program_side)
        shown = ""
        deadline = time.monotonic() + 120
        while time.monotonic() < deadline:
            try:
                shown += os.read(terminal, 4096).decode()
            except OSError:  # the program has ended
                break
            if re.search(r"increment ([2-9]|\d\d+) of", shown):
                process.send_signal(signal.SIGINT)
                break
        while True:
            try:
                chunk = os.read(terminal, 4096)
            except OSError:
                break
            if not chunk:
                break
            shown += chunk.decode()
        os.close(terminal)
        return process.wait(60), shown

    def test_interrupted_run_resumes_to_the_same_bits(self):
        # Large enough for the progress line, which appears ten times a second, to be seen in the middle.
        text = SCENE.replace("[32, 24]", "[384, 320]").replace("increments = 3", "increments = 60")
        text = text.replace('["pressure", "gap", "displacement"]', '["pressure", "gap"]')
        for choice in ("all", "last"):
            with self.subTest(choice):
                self.write("scene.toml", text.replace('increments = "all"', f'increments = "{choice}"'))
                shutil.rmtree(self.out, ignore_errors=True)
                status, shown = self.interrupt_after_first_increment()
                self.assertEqual(status, 130, shown)
                self.assertIn("brinell resume", shown)
                partial = self.summary()
                self.assertTrue(partial["interrupted"])
                self.assertFalse(partial["converged"])
                self.assertLess(len(partial["increments"]), 62)
                self.expect(self.brinell("resume", self.out), 0)
                resumed = self.summary()
                resumed_fields = (self.out / "fields.xdmf").read_text()
                self.assertEqual(resumed["increments"][:len(partial["increments"])], partial["increments"])
                whole = self.folder / f"whole_{choice}"
                self.expect(self.brinell("run", self.scene, "--out", whole), 0)
                self.assertEqual(without_times(resumed), without_times(json.loads((whole / "summary.json").read_text())))
                self.assertEqual(resumed_fields, (whole / "fields.xdmf").read_text())
                if choice == "last":
                    self.assertEqual((self.out / "fields.h5").read_bytes(), (whole / "fields.h5").read_bytes())

    def test_resume_of_a_finished_run_changes_no_result(self):
        self.expect(self.run_scene(), 0)
        before = self.summary()
        fields = (self.out / "fields.h5").read_bytes()
        self.expect(self.brinell("resume", self.out), 0)
        self.assertEqual(without_times(self.summary()), without_times(before))
        self.assertEqual((self.out / "fields.h5").read_bytes(), fields)

    def test_resume_refuses_what_is_no_run(self):
        self.expect(self.brinell("resume", self.folder / "none"), 3, "none", "run.json")
        self.expect(self.run_scene(), 0)
        checkpoint = self.out / "checkpoint.bin"
        state = checkpoint.read_bytes()
        checkpoint.write_bytes(state[:-7])
        self.expect(self.brinell("resume", self.out), 3)
        checkpoint.write_bytes(b"\xff" + state[1:])
        self.expect(self.brinell("resume", self.out), 3)
        checkpoint.unlink()
        self.expect(self.brinell("resume", self.out), 3, "checkpoint.bin")
        checkpoint.write_bytes(state)
        (self.out / "scene.toml").write_text(SCENE.replace("radius = 1e-3", "radius = 2e-3"))
        self.expect(self.brinell("resume", self.out), 3)


if __name__ == "__main__":
    unittest.main()
