"""`dihaptic check` of experiments with one mistake: each is refused with the file, the line, the key and a remedy.

Usage: broken_experiments_test.py PROGRAM, from the project's folder.
"""
import pathlib
import tempfile
import unittest

from program import dihaptic

SCENE = """bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes }
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20] }
fingers:
  - { name: thumb, shape: sphere, radius_mm: 6, mass_g: 1 }
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
"""
GOOD = """title: Everything
scene: scene.yaml
hand: { centre_mm: [0, 0, 120], aperture_mm: 80 }
task:
  hands: [{ name: pair, fingers: [thumb, index] }]
  draws:
    - { name: wait_s, exponential: { mean: 0.5, from: 0.3, to: 2 } }
    - { name: aside_mm, uniform: { from: -2, to: 2 } }
    - { name: pull, normal: { mean: 1, sd: 0.1, from: 0.5, to: 1.5 } }
    - { name: side, choice: [-1, 1], weights: [3, 1] }
    - { name: size, permutation: [small, large] }
    - { name: person, participant: yes }
  cross:
    - { factor: mass_g, levels: [100, 200] }
    - { factor: surface, levels: [suede, silk] }
  conditions:
    - { name: 200 silk, places: [{ body: block, position_mm: [0, -40, 20] }], look: [{ body: block, scale: 1.2 }] }
  variables:
    - { name: score }
    - { name: far_mm, start: 50 }
  after_trial:
    - { when: outcome == "reached" and time_in_trial < 800 ms, set: score, to: score + 1 }
    - { set: far_mm, to: "clamp(far + 1 mm, 40 mm, 60 mm)" }
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [50 * side, start.y + aside, 120], radius_mm: 6 if size == "small" else 8 }
  perturbations:
    - name: factors
      body: { body: block, density_scale: mass / 100 g, friction_scale: 0.4 if surface == "silk" else 1 }
    - name: late
      visual: { moves: [proxies], delay_ms: 80, noise_mm: [1, 1, 1] }
    - name: pulse
      during: [reach]
      profile: { delay_ms: 100, rise_ms: 20, plateau_ms: 80, fall_ms: 20, shape: minimum_jerk }
      loads:
        - { kind: constant, on: [index, block], force_N: [1, 0, 0] }
        - { kind: viscous, on: index, damping_Ns_m: 2, delay_ms: 10 }
        - { kind: curl, on: index, damping_Ns_m: 5, axis: [0, 0, 1] }
        - { kind: general, on: index, B_Ns_m: [[0, -3, 0], [3, 0, 0], [0, 0, 0]] }
        - { kind: spring, on: index, from: start, to: target, stiffness_N_m: -50, safe_within_mm: 30, fade_mm: 15 }
    - name: channel
      loads:
        - { kind: channel, on: index, about: start, normal: [0, 0, 1], stiffness_N_m: 500, damping_Ns_m: 5 }
  states:
    - name: home
      show: { targets: [start], cursor: held, bodies: { table: no } }
      perturbed: no
      message: "Trial {trial_num} of {trials}"
      lines: ["Block {block_num}"]
      place: [{ body: block, position_mm: [0, 100, 20], held: yes }]
      exits:
        - { when: inside, region: start, what: pair, hold_s: wait, to: reach }
        - { when: time, after_s: 5, outcome: lost, redo: yes }
      simulated_hand: [{ duration_s: 0.2, reach: start }]
    - name: reach
      show: [target]
      countdown: yes
      look: [{ target: target, colour: "#009e73", scale: 1.5 }]
      exits:
        - { when: norm(hand - start) > 45 mm, outcome: reached }
        - { when: touched, body: block, finger: index, count: 3, outcome: hit }
        - { when: time, after_s: 1, outcome: too slow, redo: yes }
      simulated_hand: [{ duration_s: 0.2, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }
  measures: [reaction_time, peak_speed, lateral_deviation]
  movement: { of: index, during: [reach], onset_speed_mm_s: 30, error: lateral_deviation }
  lines: ["{trials_left} trials left"]
  blocks:
    - { name: before, kind: practice, perturb: factors, pages: [{ text: Hello, key: y, for_s: 30 }] }
    - { name: pushed, kind: perturbed, perturb: [factors, pulse], rest_s: 10, insert: [{ kind: catch, count: 2, gap: 2 }] }
    - { name: shown, kind: perturbed, perturb: late, until: score >= 100 }
    - { name: held, kind: force_channel, perturb: channel }
"""
# a text in the good file, the mistake that replaces it, the key that the error names, and the advice given
MISTAKES = [
    # draws
    ("    - { name: wait_s, exp", "    - { nam: wait_s, exp", "nam", "Did you mean name?"),
    ("exponential: { mean", "exponentail: { mean", "exponentail", "Did you mean exponential?"),
    ("exponential: { mean: 0.5,", "exponential: {", "mean", "Add mean"),
    ("mean: 0.5, from: 0.3", "mean: -0.5, from: 0.3", "mean", "Correct the value"),
    ("mean: 0.5, from: 0.3, to: 2", "mean: 0.5, from: 3, to: 2", "to", "Make 'to' greater than 'from'"),
    ("uniform: { from: -2, to: 2 }", "uniform: { from: 2, to: -2 }", "to", "Make 'to' greater than 'from'"),
    ("uniform: { from: -2, to: 2 }", "uniform: 2", "uniform", "Write them below it"),
    ("uniform: { from: -2", "uniform: { from: left", "from", "Write a number"),
    ("uniform: { from: -2, to: 2 }", "uniform: { from: -2 }", "to", "Add to"),
    ("sd: 0.1", "sd: 0", "sd", "Correct the value"),
    ("from: 0.5, to: 1.5", "from: 8, to: 9", "normal", "Move 'from' and 'to' closer to the mean, or increase 'sd'"),
    ("weights: [3, 1]", "weights: [3]", "weights", "Give each value of 'choice' a weight, not all of them 0"),
    ("weights: [3, 1]", "weights: [0, 0]", "weights", "Give each value of 'choice' a weight, not all of them 0"),
    ("weights: [3, 1]", "weights: heavy", "weights", "Write weights: [0.2, 0.1]"),
    ("choice: [-1, 1], weights: [3, 1]", "choice: 1", "choice", "Start each of its items"),
    ("permutation: [small, large]", "permutation: []",
     "name", "Give it one of 'uniform', 'normal', 'exponential', 'choice', 'permutation' and"),
    ("participant: yes", "participant: 7", "participant", "Write yes or no"),
    ("participant: yes", "participant: yes, choice: [1, 2]",
     "name", "Give it one of 'uniform', 'normal', 'exponential', 'choice', 'permutation' and"),
    ("- { name: person, participant: yes }", "- { name: person }",
     "name", "Give it one of 'uniform', 'normal', 'exponential', 'choice', 'permutation' and"),
    ("- { name: person, ", "- { name: side, ", "name", "Give each a different name"),
    ("- { name: person, ", "- { name: trial_num, ", "name", "Use another name, of letters, digits and _, e.g. wait_s"),
    ("- { name: person, ", "- { name: block, ", "name", "Use another name, of letters, digits and _, e.g. wait_s"),
    # factors
    ("factor: mass_g", "factr: mass_g", "factr", "Did you mean factor?"),
    ("{ factor: mass_g, levels: [100, 200] }", "{ factor: mass_g }", "levels", "Add levels"),
    ("levels: [100, 200]", "levels: 100", "levels", "Start each of its items"),
    ("levels: [100, 200]", "levels: []", "levels", "List each level of mass_g once"),
    ("levels: [100, 200]", "levels: [100, 200, heavy]", "levels", "Write numbers, or rename the factor mass."),
    ("levels: [suede, silk]", "levels: [suede, suede]", "levels", "List each level of surface once"),
    ("factor: surface", "factor: side", "factor", "Use another name, of letters, digits and _, e.g. wait_s"),
    ("name: 200 silk", "name: 300 silk", "name", "Did you mean 100 silk?"),
    ("name: 200 silk", "name: 200 silk, factors: 200", "factors", "Write e.g. factors: { mass_g: 100 }."),
    # variables and rules
    ("- { name: score }", "- { name: score, start: none }", "start", "Write a number"),
    ("- { name: score }", "- { start: 0 }", "name", "Add name"),
    ("- { name: score }", "- { name: score, from: 0 }", "from", "Known"),
    ("- { name: score }", "- { name: wait }", "name", "Use another name, of letters, digits and _, e.g. wait_s"),
    ("far_mm, start: 50", "far_mm, start_mm: 50", "start_mm", "Known: name, start"),
    ("set: score, to: score + 1", "set: scor, to: score + 1", "set", "Did you mean score?"),
    ("set: score, to: score + 1", "to: score + 1", "set", "Add set"),
    ("set: score, to: score + 1", "set: side, to: score + 1", "set", "Known: score, far_mm"),
    ("to: score + 1 }", "to: scor + 1 }", "to", "Did you mean score?"),
    ("to: score + 1 }", "to: score + 1 mm }",
     "to", "Give both sides the same dimension, and numbers their unit (5 mm, 200 ms, 2 N)"),
    ("to: score + 1 }", "to: score > 1 }", "to", "Convert a condition to a number with 'if', e.g. 10 if side > 0 else 20"),
    ("to: score + 1 }", "to: score + }", "to", "Complete the expression"),
    ('when: outcome == "reached"', 'when: outcome == "reachd"', "when", "Did you mean"),
    ("time_in_trial < 800 ms", "time_in_trial < 800 mm",
     "when", "Give both sides the same dimension, and numbers their unit (5 mm, 200 ms, 2 N)"),
    ('when: outcome == "reached" and', "when: score and", "when", "Compare it"),
    # formulas
    ("[50 * side, start.y + aside, 120]", "[50 * sid, start.y + aside, 120]", "position_mm", "Did you mean side?"),
    ("[50 * side, start.y + aside, 120]", "[50 * side, start.y + wait, 120]",
     "position_mm", "Give both sides the same dimension, and numbers their unit (5 mm, 200 ms, 2 N)"),
    ("[50 * side, start.y + aside, 120]", "[500000 * side, 0, 120]",
     "position_mm", "Correct the formula or the quantities in it"),
    ("[50 * side, start.y + aside, 120]", "[50 * side, grip_force / 1 N, 120]",
     "position_mm", "Use draws, factors, variables and regions; or use a condition under 'when'"),
    ('radius_mm: 6 if size == "small" else 8', 'radius_mm: 6 if size == "tiny" else 8',
     "radius_mm", "Possible: small, large"),
    ('radius_mm: 6 if size == "small" else 8', 'radius_mm: 6 if size == "small"', "radius_mm", "else"),
    ("density_scale: mass / 100 g", "density_scale: mass",
     "density_scale", "Divide by a unit, e.g. wait / 1 s, or use another quantity"),
    ("density_scale: mass / 100 g", "density_scale: mass / 1 g",
     "density_scale", "Correct the formula or the quantities in it"),
    # what is shown late and shaken
    ("delay_ms: 80, noise", "delay: 80, noise", "delay", "Write delay_s or delay_ms"),
    ("delay_ms: 80, noise", "delay_mm: 80, noise", "delay_mm", "Write delay_s or delay_ms"),
    ("delay_ms: 80, noise", "delay_ms: 8000, noise", "delay_ms", "Correct the value"),
    ("noise_mm: [1, 1, 1]", "noise_mm: 1", "noise_mm", "Write noise_mm: [x, y, z]"),
    ("noise_mm: [1, 1, 1]", "noise_mm: [1, -1, 1]", "noise_mm", "Correct the value"),
    ("moves: [proxies], delay", "moves: [target], delay", "delay", "Add 'proxies' to 'moves'"),
    # during and profile
    ("during: [reach]\n      profile", "during: [rech]\n      profile", "during", "Did you mean reach?"),
    ("during: [reach]\n      profile", "during: [home]\n      profile", "during", "Leave out one or the other"),
    ("during: [reach]\n      profile", "durign: [reach]\n      profile", "durign", "Did you mean during?"),
    ("rise_ms: 20", "rise: 20", "rise", "Write rise_s or rise_ms"),
    ("rise_ms: 20", "rise_ms: -20", "rise_ms", "Correct the value"),
    ("rise_ms: 20", "rises_ms: 20", "rises_ms", "Did you mean rise_ms?"),
    ("plateau_ms: 80, ", "", "fall", "Add e.g. plateau_ms: 100, the time between rise and fall"),
    ("shape: minimum_jerk", "shape: sine", "shape", "Use linear or minimum_jerk"),
    # loads
    ("kind: constant, on", "kind: constnt, on", "kind", "Use constant"),
    ("- { kind: constant, on", "- { on", "kind", "Add kind"),
    ("on: [index, block]", "on: [index, blok]", "on", "Did you mean block?"),
    ("on: [index, block]", "on: [index, table]", "on", "Name a movable body, or a finger"),
    ("on: [index, block], ", "", "on", "Add on"),
    ("force_N: [1, 0, 0]", "force_N: 1", "force_N", "Write force_N: [x, y, z]"),
    ("force_N: [1, 0, 0]", "force_mm: [1, 0, 0]", "force_mm", "Write force_N or force_mN"),
    ("force_N: [1, 0, 0]", "force_N: [1000000, 0, 0]", "force_N", "Correct the value"),
    ("force_N: [1, 0, 0]", "torque_Nm: [0, 0, 0.1]",
     "torque", "Leave it out, let it act on a body, or use a rig with torque"),
    ("damping_Ns_m: 2, delay_ms: 10", "delay_ms: 10", "damping", "Add e.g. damping_Ns_m: 10"),
    ("damping_Ns_m: 2, delay_ms: 10", "damping_Ns_m: 2, axis: [0, 0, 1]", "axis", "Known"),
    ("damping_Ns_m: 2, delay_ms: 10", "damping_Ns_m: 2, delay_ms: 3000", "delay_ms", "Correct the value"),
    ("damping_Ns_m: 5, axis: [0, 0, 1] }", "damping_Ns_m: 5 }", "axis", "Write it in world axes, e.g. axis: [0, 0, 1]"),
    ("damping_Ns_m: 5, axis: [0, 0, 1] }", "damping_Ns_m: 5, axis: [0, 0, 0] }",
     "axis", "Write it in world axes, e.g. axis: [0, 0, 1]"),
    ("B_Ns_m: [[0, -3, 0], [3, 0, 0], [0, 0, 0]]", "B_Ns_m: [0, -3, 0]", "B_Ns_m", "Write B_Ns_m: [["),
    ("B_Ns_m: [[0, -3, 0], [3, 0, 0], [0, 0, 0]]", "A_N_m: [[9, 0, 0], [0, 0, 0], [0, 0, 0]]",
     "about", "Name a region, e.g. about: start"),
    ("stiffness_N_m: -50, safe_within_mm: 30, ", "stiffness_N_m: -50, ",
     "stiffness", "Add e.g. safe_within_mm: 50, beyond which the load fades to zero"),
    ("safe_within_mm: 30", "break_out_mm: 30", "break_out_mm", "Known"),
    ("from: start, to: target, stiffness_N_m: -50", "from: start, to: tarket, stiffness_N_m: -50",
     "to", "Did you mean target?"),
    ("from: start, to: target, stiffness_N_m: -50", "from: start, stiffness_N_m: -50", "to", "Known: start, target"),
    ("fade_mm: 15", "fade_mm: 0", "fade_mm", "Correct the value"),
    ("about: start, normal: [0, 0, 1]", "about: start",
     "normal", "Add e.g. normal: [0, 0, 1], or name 'from' and 'to' instead of 'about'"),
    ("stiffness_N_m: 500, damping", "stiffness_N_m: -500, damping", "stiffness_N_m", "Correct the value"),
    ("stiffness_N_m: 500, damping_Ns_m: 5", "stiffness_N_m: 500, one_sided: yes", "one_sided", "Known"),
    # what is seen
    ("show: { targets: [start], cursor", "show: { targets: [strat], cursor", "show", "Did you mean start?"),
    ("cursor: held", "cursor: hidden", "cursor", "Use yes, no or held"),
    ("bodies: { table: no } }", "bodies: { tabel: no } }", "bodies", "Did you mean table?"),
    ("bodies: { table: no } }", "bodies: { table: gone } }", "table", "Write yes or no"),
    ("bodies: { table: no } }", "fingers: { table: no } }", "fingers", "Known: thumb, index"),
    ('message: "Trial {trial_num}', 'message: "Trial {trail_num}', "message", "Did you mean trial_num?"),
    ('lines: ["Block {block_num}"]', "lines: [a, b, c]", "lines", "Leave some out"),
    ('lines: ["Block {block_num}"]', "lines: Block", "lines", "Start each of its items"),
    ('lines: ["{trials_left} trials left"]', 'lines: ["{trials_lef} left"]', "lines", "Did you mean trials_left?"),
    ("countdown: yes", "countdown: 3", "countdown", "Write yes or no"),
    ("countdown: yes\n      look: [{ target: target", "look: [{ target: tarket", "target", "Did you mean target?"),
    ('colour: "#009e73"', "colour: green",
     "colour", 'Write red, green and blue in hexadecimal, e.g. colour: "#d55e00"'),
    ("scale: 1.5", "scale: 100", "scale", "Correct the value"),
    ("look: [{ body: block, scale: 1.2 }]", "look: [{ body: block }]", "look", "Give it 'colour', 'scale' or 'hidden'"),
    # placing
    ("body: block, position_mm: [0, 100, 20], held", "body: blok, position_mm: [0, 100, 20], held",
     "body", "Did you mean block?"),
    ("body: block, position_mm: [0, 100, 20], held", "body: table, position_mm: [0, 100, 20], held",
     "held", "Leave it out"),
    ("body: block, position_mm: [0, 100, 20], held", "body: block, position: [0, 100, 20], held",
     "position", "Write position_m, position_mm"),
    ("held: yes }]", "held: yes, removed: yes }]", "removed", "Leave out position_mm and 'held'"),
    ("position_mm: [0, 100, 20], held: yes }]", "held: no }]",
     "position", "Add position_mm, velocity_mm_s, held: yes or removed: yes"),
    # conditions
    ("when: inside, region: start, what: pair", "when: inside, region: strat, what: pair",
     "region", "Did you mean start?"),
    ("what: pair", "what: pear", "what", "Did you mean pair?"),
    ("what: pair", "what: pair, finger: index", "finger", "Leave it out"),
    ("when: inside, region: start, what: pair", "when: insid, region: start, what: pair",
     "region", "Did you mean when: inside?"),
    ("hold_s: wait, to: reach", "hold_s: wiat, to: reach", "hold_s", "Did you mean wait?"),
    ("hold_s: wait, to: reach", "hold_s: aside, to: reach",
     "hold_s", "Divide by a unit, e.g. wait / 1 s, or use another quantity"),
    ("hold_s: wait, to: reach", "hold_s: 2 * grip_force / 1 N, to: reach",
     "hold_s", "Use draws, factors, variables and regions; or use a condition under 'when'"),
    ("norm(hand - start) > 45 mm", "norm(hand - start) > 45 ms",
     "when", "Give both sides the same dimension, and numbers their unit (5 mm, 200 ms, 2 N)"),
    ("norm(hand - start) > 45 mm", "norm(hnd - start) > 45 mm", "when", "Did you mean hand?"),
    ("norm(hand - start) > 45 mm", "norm(hand - start)",
     "when", "Compare it with a value, e.g. norm(hand - start) > 2"),
    ("norm(hand - start) > 45 mm", "norm(hand - start > 45 mm",
     "when", "Compare numbers with numbers, and texts with quoted texts"),
    ("norm(hand - start) > 45 mm,", "norm(hand - start) > 45 mm, region: start,",
     "region", "It belongs to when: inside, outside"),
    ("norm(hand - start) > 45 mm,", "norm(hand - start) > 45 mm, height_mm: 5,",
     "height_mm", "It belongs to when: lifted"),
    ("when: inside, region: start, what: pair", "when: gripped(block, pair)",
     "pair)", 'Put that text in quotes, e.g. when: "gripped(block, hand)"'),
    ("count: 3", "count: 0", "count", "Correct the value"),
    ("count: 3", "count: many", "count", "Write a number"),
    ("count: 3", "count: 2.5", "count", "Leave out the decimals"),
    ("- { when: time, after_s: 1,", "- { when: time, count: 2, hold_s: 1,",
     "count", "It belongs to when: inside, outside, touched, released, gripped"),
    ("finger: index, count: 3", "finger: indx, count: 3", "finger", "Did you mean index?"),
    # hands
    ("{ name: pair, fingers: [thumb, index] }", "{ name: pair, fingers: [thumb, indx] }",
     "fingers", "Did you mean index?"),
    ("{ name: pair, fingers: [thumb, index] }", "{ name: pair, fingers: [] }", "fingers", "Name at least one"),
    ("{ name: pair, fingers: [thumb, index] }", "{ name: pair }", "fingers", "Add fingers"),
    ("{ name: pair, fingers: [thumb, index] }", "{ name: thumb, fingers: [thumb, index] }",
     "name", "Give the hand another name"),
    ("{ name: pair, fingers: [thumb, index] }", "{ name: pair, finger: [thumb] }", "finger", "Did you mean fingers?"),
    # measures and movement
    ("measures: [reaction_time,", "measures: [reaction_tim,", "measures", "Did you mean reaction_time?"),
    ("measures: [reaction_time, peak_speed", "measures: [peak_speed, peak_speed", "measures", "Leave one out"),
    ("measures: [reaction_time, peak_speed, lateral_deviation]", "measures: lateral_deviation",
     "measures", "Start each of its items"),
    ("movement: { of: index,", "movement: { of: indx,", "of", "Did you mean index?"),
    ("movement: { of: index, during: [reach]", "movement: { of: index, during: [rech]",
     "during", "Did you mean reach?"),
    ("onset_speed_mm_s: 30", "onset_speed: 30", "onset_speed", "Write onset_speed_m_s"),
    ("onset_speed_mm_s: 30", "onset_speed_mm_s: 0", "onset_speed_mm_s", "Correct the value"),
    ("error: lateral_deviation }", "error: path_length }",
     "error", "Known: reaction_time, peak_speed, lateral_deviation"),
    ("error: lateral_deviation }", "go: rech }", "go", "Did you mean reach?"),
    # blocks: pages, breaks, perturbations, inserts, until
    ("pages: [{ text: Hello,", "pages: [{ txt: Hello,", "txt", "Did you mean text?"),
    ("pages: [{ text: Hello,", "pages: [{ picture: none.png,", "picture", "Name a PNG or GIF file, relative to this one"),
    ("pages: [{ text: Hello,", "pages: [{", "pages", "Give the page text, picture or both"),
    ("key: y,", "key: yes please,", "key", "Write one letter or digit, or leave it out to accept any key"),
    ("for_s: 30", "for: 30", "for", "Write for_s or for_ms"),
    ("rest_s: 10", "rest_s: 7200", "rest_s", "Correct the value"),
    ("perturb: [factors, pulse]", "perturb: [factors, puls]", "perturb", "Did you mean pulse?"),
    ("perturb: [factors, pulse]", "perturb: [pulse, pulse]",
     "perturb", "Name it once, and make it stronger if needed"),
    ("perturb: [factors, pulse]", "perturb: { pulse: 1 }", "perturb", "Write perturb: a"),
    ("gap: 2", "gap: 0", "gap", "Correct the value"),
    ("gap: 2", "gap: 9", "gap", "Insert fewer, reduce 'gap', or increase the block's repeats"),
    ("count: 2, gap", "count: 9, gap", "count", "Insert fewer, or increase the block's repeats"),
    ("count: 2, gap", "gap", "count", "Add count"),
    ("until: score >= 100", "until: scor >= 100", "until", "Did you mean score?"),
    ("until: score >= 100", "until: score", "until", "Write a comparison"),
    ("until: score >= 100", "until: block.z > 1", "until", "docs/files/expressions.md says which names there are"),
    ("kind: force_channel, perturb: channel", "kind: force_channel, perturb: late",
     "kind", "Name a perturbation whose field is a channel"),
    ("kind: force_channel, perturb: channel", "kind: error_clamp, perturb: channel", "kind", "Write visual_clamp"),
]


def line_of(what, by):
    """Line of the first character that the mistake changes."""
    same = next(i for i, pair in enumerate(zip(what + "\0", by + "\0")) if pair[0] != pair[1])
    return GOOD.count("\n", 0, GOOD.index(what) + same) + 1


class BrokenExperiments(unittest.TestCase):
    def test_each_mistake_is_refused_with_file_line_key_and_remedy(self):
        self.assertGreaterEqual(len(MISTAKES), 80)
        with tempfile.TemporaryDirectory() as folder:
            def write(name, text):
                path = pathlib.Path(folder, name)
                path.write_text(text)
                return str(path)

            write("scene.yaml", SCENE)
            good = dihaptic("check", write("good.yaml", GOOD))
            self.assertEqual(good.returncode, 0, good.stdout)
            told = [line for line in good.stdout.splitlines() if ": warning: " in line]
            # of what simulated people do unlike people
            for line, known in zip(told, ("late: is shown late", "pulse: pushes the hand"), strict=True):
                self.assertIn(known, line)
            files = []
            for i, (what, by, _, _) in enumerate(MISTAKES):
                self.assertEqual(GOOD.count(what), 1, what)
                files.append(write(f"broken-{i:03}.yaml", GOOD.replace(what, by)))
            result = dihaptic("check", *files)
            self.assertEqual(result.returncode, 2)
            said = result.stdout.splitlines()
        for file, (what, by, key, remedy) in zip(files, MISTAKES):
            with self.subTest(what=what, by=by):
                begin = f"{file}:{line_of(what, by)}: error: {key}: "
                about = [line for line in said if line.startswith(file)]
                self.assertTrue(any(line.startswith(begin) and remedy in line[len(begin):] for line in about),
                                f"expected: {begin}... {remedy}\nbut: " + "\n".join(about))


if __name__ == "__main__":
    unittest.main(verbosity=2)
