"""Every constant that decides: what it controls, and why it has its value."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Criteria:
    """Constants of the search and the verdict.

    Attributes
    ----------
    max_rows : int
        Rows of the linear screening; denser samples are averaged in blocks, whose length stays below a degree of the
        circle at two feeds, two directions and two laps of seven circles.
    block_turns : float
        Turns of a screw in which readings of a block are averaged, at most: their mean loses 1.6 % of a pitch error,
        less than forms differ.
    fit_rows : int
        Rows of the full fits, evenly spread: some tens for each free value; all rows follow to first order.
    thinned_rows : int
        Rows of which questions of rank are asked: which learned functions contain a form, which are worth a full look.
        A signature has some tens of degrees of freedom.
    fewest_rows : int
        The same where nothing is learned and only homes are asked for.
    same_form : float
        Explained part of a signature from which a learned hypothesis is said to contain it (its home).
    form_home : float
        Explained part from which a hypothesis at the best one's place lends its functions to a discrepancy: functions
        of direction and position contain 96 % of play, whose form they must be able to mend.
    form_own : float
        Explained part from which a function's variable is the effect's own, so that each leg or slider may follow a law
        of its own: legs that sag are a hundredth off functions of their place, which one slider's screw follows too.
    near_form : float
        Where none contains it, the hypotheses nearest to it from this part on stand for its discrepancy: a spike that
        depends on travel and time at once is contained to six and seven tenths by functions of either.
    most_homes : int
        Functions of so many variables stand for a discrepancy; more add columns and no freedom.
    shape_starts : tuple of float
        Starts of a shape parameter (the logarithm of a time), in prior standard deviations: first order cannot move it.
    shapes_for_all : tuple of float
        Values tried, in prior standard deviations, of a shape that all elements of an effect share: with a shape each,
        screws that warm alike were fitted as fast ones and slow ones. Half a standard deviation apart: between two, a
        third of a time constant is gained or lost, which rates of their own make up for. Farther apart beyond two, up
        to what sliders have that stick at reversals for most of a second: 50 ms at zero, 0.77 s at 3.9.
    shape_rounds : int
        Steps of Gauss and Newton for shapes of users' effects: enough to compare; what is added is fitted on.
    constant_rounds : int
        Steps of Gauss and Newton for the time that a learned function remembers: from one of the few first tried it has
        to move by less than half of the way to the next.
    least_seen : float
        Directions of a learned prior of which the readings tell less than this part of a value's worth are left out of
        full fits.
    most_seen : int
        Directions in a full fit, the best seen: its time grows with their square; with 30 the place of a dent is lost.
        Shared by the axes where the direction is not known.
    most_tuned : int
        The same of a function that is tuned about the fit of its set, which few are: a time constant of half a minute
        in a test of an hour needs 300, a joint between two pieces of rail 250. All functions of a set together have as
        many when no further one is added.
    most_of_each : int
        The same of six elements with a function each: the lobes of six balls need a hundred splines each.
    finer_at_once : tuple of int
        Multiples of splines with which the functions that have the most evidence are screened besides: twice and four
        times a dozen follow what repeats three or six times within a range.
    most_finer : int
        Values of a function that is screened again with more splines where nothing settles: four times those of a
        slider's position by either direction of travel, and of nearly all others.
    predicts_alike : float
        Ratio of mean squares left of circles left out below which two sets of splines are taken to predict alike, so
        that evidence chooses: nine of ten readings are fitted either way, the rest say no more than this.
    step_mm : float
        Prior standard deviation of steps found already, while the next is sought: beyond any step.
    shortest_mm : float
        Shortest period of a position: below, neighbouring readings no longer follow it at a usual feed.
    form_visible : float
        Directions of a discrepancy of which geometry leaves less than this part are geometry's.
    extrapolates : float
        Held-out error over fitted error of the base from which a group lies outside what the others determine; so does
        one for which a fit to the others expects an error of as many times the noise.
    most_rounds : int
        Exchanges of causes, lest two take turns.
    most_of_one_effect : int
        Elements of one effect that get a full fit in one step: neighbours look alike to first order.
    prior_tail : float
        Degrees of freedom of Student's t, the prior of what an effect pushes: with 4 an effect of the size
        expected costs what a normal prior makes it cost, three values of 35 standard deviations together (a joint
        1.8 mm off its place) twenty nats, not 600.
    form_sigma : float
        Standard deviation (half-normal) of the relative difference between an effect's form and the machine's.
    form_grid : tuple of float
        Relative differences over which the evidence is averaged.
    temper : float
        Part of the unexplained RMS that counts as noise while screening: first-order signatures are not exact, and a
        form of this relative difference must not exclude its effect.
    roughness : tuple of float
        Penalties over which the evidence of a spline is averaged: white coefficients to nearly a parabola.
    tuned_penalties : tuple of (float, float)
        Penalties of second and of first differences over which it is averaged about the fit of a set, where little is
        left to count as noise: coefficients of their own to a line, and to a constant, which offsets nearly are.
    ranking_roughness : float
        The one penalty with which learned functions are ranked before the few best are scored: the middle one.
    size_um : tuple of float
        Sizes of a learned function over which the evidence is averaged: smallest, largest, number (geometric).
    catalogue_scale : tuple of float
        Multiples of an effect's prior standard deviation over which its evidence is averaged in the screening.
    detect_nats : float
        Log evidence over the base (multiplicity included) below which nothing is named.
    margin_nats : float
        Log evidence by which the named must exceed the best rival of another kind.
    domain_sigmas : float
        A value this many standard deviations outside its physical domain refuses a hypothesis.
    full_fits : int
        Hypotheses of each kind that get a full fit.
    later_fits : int
        The same beside hypotheses already found.
    in_other_words : int
        Known effects that get a full fit for the functions of their own place and variable, not for their exact form,
        the best: legs that warm by a law of their own explain by the catalogue's an eighth of what they do.
    held_out : int
        Hypotheses, of the largest evidence, that are also judged by circles left out while screening: twice as many as
        get a full fit.
    most_steps : int
        Steps of one thing, at most: a count lost again and again, a gauge that jumps back and forth. Shared by the axes
        where the direction is not known: six steps of three axes each imitate whatever differs from circle to circle.
    change_part : float
        Part of a circle's readings about its beginning in which one step is sought, but no second one: rows are thinned
        to some hundred a circle, which place an instant to a few hundredths of it.
    max_effects : int
        Effects looked for at once.
    heldout_share_min : float
        Part of the share explained where fitted that must be explained where held out.
    refined_heldout_min : float
        Share, held out to first order, below which a refinement is not fitted in full: with splines not chosen yet,
        what predicts in the end may miss by half of what it explains.
    heldout_ratio : float
        Error where held out over the error that the fit expects of itself, beyond which a hypothesis is refuted.
        Where geometry leads away (`leads_away`), what it expects beyond the noise may by chance be that much larger.
    beam : int
        Sets of hypotheses that are followed where one does not explain all.
    known_sets : int
        Sets of known effects of each size that get a full fit: neighbours in the ranking differ by an element.
    known_sets_followed : int
        Sets of a size that are widened by every effect: what belongs to the best of three is among the best of two
        unless thirty others imitate it.
    max_expansions : int
        Sets beside which all hypotheses are screened, at most: bounds the time of a search.
    most_expansions : int
        The same with those by which a set is looked at again (`exchange.py`).
    complete : float
        Part of what was unexplained that may be left where the search for a further cause is not widened.
    leaves_structure : float
        Mean square (noise variances) left from which a hypothesis' remainder bends geometry, and from which a learned
        function settles nothing: it may be too coarse, turn over too sharply, or be another's. Its root is the 1.14
        times the noise that is left of a goal of 1.3 where other circles are predicted.
    leaves_more : float
        Mean square (noise variances) left by a learned function from which those that are looked at last are screened
        too: seven standard deviations of it at 10,000 readings, and more than the noise is uncertain by.
    form_explains : float
        Part of the unexplained from which an effect that does not predict circles left out may still be the cause with
        another form: a form 20 % off, the largest that the calibration has, leaves 4 % of it, twice that where no
        function beside the effect holds the difference. Where an effect stood in for another it was 80 %. The same from
        which formulas are said to explain nearly all: that of a joint which stood in for lobes of the other leg's joint
        explained 0.65. Two that stood in for one other effect explained 0.97: of several it is not enough. The same of
        an effect at several elements, to be named for sure: of five true ones it was 0.93 and more, of lags of six
        drives that stood in for a guideway that yields 0.82.
    formula_explains : float
        Part of the unexplained that the formulas of several effects, or of one so excused, or that no circles left out
        test (`leads_away`), must explain to be named for sure: of one 20 % off, the largest that the calibration has,
        it was 0.38 and more where geometry takes most of it, of sets that stood in for others down to 0.05. Several
        that leave something must explain `explained_min` so: of sixty true pairs it was 0.75 and more but for six that
        left noise alone, of ten sets that stood in for what drags, tips or tautens 0.30 to 0.72.
    formula_names : float
        The same that the formula of one effect, of quite another form (`form_named`) or elsewhere than a function that
        predicts, must explain to take its place: of a joint 20 % off, of which geometry takes most, it was 0.27; of
        leads and legs that stood in for bumps and for a ball that settles 0.01 to 0.17. Also the part of what the
        others leave that each of several must explain where their formulas leave much (`form_explains`): 0.25 of the
        lesser of a true pair, negative for two of three screws that cancelled.
    formula_most : float
        Part of the unexplained that the formula of an effect must explain for the function in which it lives to be its
        form, not another cause: the larger part. Of a lead 20 % off its form, whose straight part geometry takes too,
        it was 0.74. The same part of what one of several that are not for sure does beside the others, where a function
        at its place predicts.
    formula_beside : float
        Part of what functions leave that the formula of an effect elsewhere must explain to stand beside them: of 35
        records it was 0.46 and more for four effects that were there, for others 0.23 and less but for two at the place
        of a function.
    formula_leaves : float
        Part of what known effects leave, by their formulas or with the functions of their forms, that the formula of
        another must explain to be there too: of 110 records five that were there had 0.9 and more, all others 0.77 and
        less but for one at an element of theirs.
    formula_least : float
        Part of what an effect explains beside others, with the functions of its form, that its formula must explain: a
        bow beside a ball that sits otherwise in every circle had 0.19, a drift that stood in for what a delay leaves
        0.07.
    own_formula : float
        Part of what an effect explains, and of what the others leave, that its own formula must explain for it to be
        for sure although geometry does not predict what was left out: forms 20 % off, of which geometry takes half of
        what the effect does, leave up to 0.15. Of seven sets with a wrong member one had 0.79 for its least part, the
        others 0.7 and less.
    missed_most : float
        Error of what was left out, beyond what the fit expects of itself, over the RMS explained where fitted, above
        which causes that predict are looked at further (for several causes that contradict the others, `by_chance`:
        beyond the noise): effects 20 % off their formula, the largest that the
        calibration has, reach 0.76, those that stood in for faults outside the catalogue 0.8 to 1.2.
    missed_sure : float
        The same above which they are not named for sure: of forty effects up to 20 % off, ten times the noise, all
        whose formula bends had 0.3 and less, drifting legs that stood in for a screw 0.78. Where formulas explain
        nearly all (`form_explains`) it is `missed_most`: of true pairs those had up to 0.73, of what stood in 1.03 and
        more.
    missed_bent : float
        The same above which nothing is named for sure, nor one effect that its form excuses, nor one whose formula,
        hardly bent, leaves only noise. Of sixty effects up to 20 % off, those that left only noise had 0.9 and less,
        one joint of which geometry takes most 1.31; five that stood in for other causes had 1.48 (a step of a rail,
        called a bow) to 3.7. The value is between the two.
    missed_far : float
        Error of what was left out, over the RMS explained where fitted, from which nothing but its evidence tests one
        effect, however little geometry is held: a function that has more of it is as likely. Of twelve balls that sit
        otherwise, up to 20 % off, the largest was 1.0, of a lead that bends 3.5; of cups and balls that go by the
        platform's tilt, called such a ball, 5 to 12.
    leads_away : float
        Error of geometry alone on what was left out, over what it leaves where fitted, from which that says nothing of
        one effect whose formula explains nearly all (`form_explains`), nor for several whose formulas do not: circles
        that hold geometry leave it at 3 to 7, others at 16 to 150.
    by_chance : float
        Largest contradiction between the readings left out and the others that counts as chance: the squared distance
        of the fitted values, in standard deviations, per value; 1 is expected. Thirty true sets, three times the noise,
        had 6 or less, one had 17; twenty wrong or incomplete sets had 17 to several hundred. The same for the squared
        error on readings left out, over what is expected, of effects that explain by their own formulas: both are
        squares of few values that hardly anything determines.
    far_better : float
        Known effects together stand before one that its form excuses where they err by less than this part of its
        error: a true pair erred by 0.28 of it, the same with a wrong element by 0.49 and more. The same part of what
        several causes leave that explain less than `explained_min`: one function that leaves less is a lead in their
        place, whether it predicts or not. The same part of what an effect at all elements misses: at one of them it
        missed 0.31 of it where that element alone was at fault. The same part of what is left without an effect from
        which on it is told at those of its elements where it is seen.
    most_refinements : int
        Functions that describe the forms of the causes found, at most: one for each of six legs, and two of all.
    refined_by : float
        Part of what is left beyond the noise that each of them must explain: many that explain a little each describe
        single readings about reversals.
    refinement_rounds : int
        Rounds of finer functions and functions beside them: those beside get their splines in the round after.
    refined_to : float
        Mean square (noise variances) at which forms are described well enough: the noise itself, but for a hundredth.
    predicted_to : float
        Held-out error (noise standard deviations) at which they predict well enough: below the goal of 1.3, and further
        functions, or functions as stiff as the readings allow, gain a few hundredths.
    explained_min : float
        Part of the unexplained that the causes named must explain together. Also the part of what functions explain
        beside other causes that known effects must explain in their place.
    form_limit : float
        Relative difference of form above which a catalogue effect is not called the cause: forms 20 % off, the largest
        that the calibration has, measure up to 0.42, a drive that lags in one direction alone 0.45.
    form_named : float
        The same from which what explains nearly as much (`same_kind_share`) is named beside the effect: forms 20 % off,
        the largest that the calibration has, measure up to 0.19, 0.42 where geometry takes most of the effect itself.
    form_as_seen : float
        The same where the effect stands alone and geometry leaves more than `form_seen` of its mean square: 150 faults
        of forms 20 % off measure up to 0.228 then, a gauge that saturates 0.238, a drive that lags above a speed 0.289.
    form_seen : float
        Part of an effect's mean square above which its form is measured well. Of leads, bows and joints off their
        places geometry leaves less than 0.02, of play, lags and gauges 0.06 and more, at 100 times the noise too.
    form_exact : float
        The same up to which an effect is its formula as it is: what leaves only noise so, or the square of
        `form_described` of what it explains, is named for sure though it errs on circles left out by more than
        `missed_sure`: a joint, a screw that warms. Of those that did so true ones left 0.2 % and less, a beam that
        sags, called a bowed guideway, 0.6 % and more. A platform that warms reads as legs that grow a hundredth off,
        but leaves a quarter of the noise's variance.
    same_kind_share : float
        Part of the unexplained by which a known effect may lag behind the learned function that contains it.
    secondary : float
        Factor on the variance that the forms of the causes found may leave, which a further cause must exceed: twice
        `form_sigma` squared is a form 20 % off, the largest that the calibration has.
    form_described : float
        Part of a form that the functions beside an effect leave undescribed, at most: a further known effect, itself
        larger than forms may be off, must explain more than `secondary` times its square where others stand in for
        most of it: a bow beside a screw that warms in a way of its own explained 0.8 of that.
    no_form : float
        Multiple of what any function at the causes' own places explains that a further known effect, or a function
        elsewhere, must explain to be no form of theirs, however small beside them: true ones a tenth as large had 2.6
        and more, one that stood in for a form 1.2.
    apart : float
        Part of what known effects leave that a function elsewhere must explain to be no form of theirs: the larger
        part. A gauge's battery and mains hum, a fifth as large as a lag and as play, explained 0.77 and 0.65; functions
        of other states 0.16 and less.
    of_size : float
        Part of what three and more known effects explain that the squares of what they push beyond geometry must sum
        to, and one over it the most: of true triples it is 0.34 to 2.6; three drifts that stood in for a ball off its
        axis had 0.06, joints off their places that stood in for a guideway that warms 6.
    """

    max_rows: int = 12000
    block_turns: float = 0.1
    fit_rows: int = 3000
    thinned_rows: int = 2400
    fewest_rows: int = 1200
    same_form: float = 0.97
    form_home: float = 0.9
    form_own: float = 0.995
    near_form: float = 0.5
    most_homes: int = 3
    shape_starts: tuple[float, ...] = (-1.5, 0.0, 1.5)
    shapes_for_all: tuple[float, ...] = (-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.6, 3.2, 3.9)
    shape_rounds: int = 3
    constant_rounds: int = 3
    least_seen: float = 0.05
    most_seen: int = 100
    most_tuned: int = 400
    most_of_each: int = 800
    finer_at_once: tuple[int, ...] = (2, 4)
    most_finer: int = 128
    predicts_alike: float = 1.1
    step_mm: float = 1.0
    shortest_mm: float = 0.4
    form_visible: float = 0.02
    extrapolates: float = 2.0
    most_rounds: int = 2
    most_of_one_effect: int = 2
    prior_tail: float = 4.0
    form_sigma: float = 0.15
    form_grid: tuple[float, ...] = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4)
    temper: float = 0.1
    roughness: tuple[float, ...] = (1.0, 30.0, 1000.0)
    tuned_penalties: tuple[tuple[float, float], ...] = (
        *((roughness, 0.0) for roughness in (0.1, 1.0, 10.0, 100.0, 1e3, 1e5)),
        *((1.0, steepness) for steepness in (10.0, 1e3, 1e5)),
    )
    ranking_roughness: float = 30.0
    size_um: tuple[float, float, int] = (0.03, 3000.0, 26)
    catalogue_scale: tuple[float, ...] = (0.1, 0.3, 1.0, 3.0, 10.0)
    detect_nats: float = 5.0
    margin_nats: float = 5.0
    domain_sigmas: float = 3.0
    full_fits: int = 5
    later_fits: int = 3
    in_other_words: int = 1
    held_out: int = 12
    most_steps: int = 6
    change_part: float = 0.05
    max_effects: int = 4
    heldout_share_min: float = 0.5
    refined_heldout_min: float = -0.5
    heldout_ratio: float = 1.5
    beam: int = 2
    known_sets: int = 3
    known_sets_followed: int = 30
    max_expansions: int = 4
    most_expansions: int = 6
    complete: float = 0.02
    leaves_structure: float = 1.3
    leaves_more: float = 1.1
    form_explains: float = 0.9
    formula_explains: float = 1.0 / 3.0
    formula_names: float = 0.2
    formula_most: float = 0.5
    formula_beside: float = 0.35
    formula_leaves: float = 0.85
    formula_least: float = 0.1
    own_formula: float = 0.8
    missed_most: float = 0.8
    missed_sure: float = 0.5
    missed_bent: float = 1.4
    missed_far: float = 4.0
    leads_away: float = 10.0
    by_chance: float = 10.0
    far_better: float = 0.5
    most_refinements: int = 8
    refined_by: float = 0.1
    refinement_rounds: int = 2
    refined_to: float = 1.01
    predicted_to: float = 1.2
    explained_min: float = 0.75
    form_limit: float = 0.42
    form_named: float = 0.3
    form_as_seen: float = 0.235
    form_seen: float = 0.05
    form_exact: float = 0.1
    same_kind_share: float = 0.05
    secondary: float = 2.0
    form_described: float = 0.05
    no_form: float = 2.0
    apart: float = 0.5
    of_size: float = 0.25

    @property
    def form_variance(self) -> float:
        """Part of what causes explain that their forms may leave, at most."""
        return self.secondary * self.form_sigma**2


DEFAULT = Criteria()
