"""Two optimizers that choose candidates with a model of the objectives: qLogEHVI of BoTorch and ParEGO of SMAC.

Both know the architecture as a category. They are Bayesian optimizers, whose own time grows with the number of evaluations: they are
compared after few.
"""

import math

import numpy as np

# The modelled mass is limited, so that designs that no front needs do not decide the fit.
HEAVIEST = 1e5
REFERENCE = 2000.0


def qehvi(job, evaluator, design_text, lower, upper):
    """Run qLogEHVI with Gaussian processes of ln mass, radius and violation; one candidate at a time after 60 of a Sobol sample.

    An evaluation has no noise, so that qNEHVI would compute the same improvement at many times the cost. That of qLogEHVI doubles with every
    candidate of a batch.
    """
    import torch
    from botorch.acquisition.multi_objective.logei import qLogExpectedHypervolumeImprovement
    from botorch.acquisition.multi_objective.objective import GenericMCMultiOutputObjective
    from botorch.fit import fit_gpytorch_mll
    from botorch.models import MixedSingleTaskGP, ModelListGP, SingleTaskGP
    from botorch.models.transforms import Standardize
    from botorch.optim import optimize_acqf, optimize_acqf_mixed
    from botorch.sampling import SobolQMCNormalSampler
    from botorch.utils.multi_objective.box_decompositions.non_dominated import FastNondominatedPartitioning
    from gpytorch.mlls import SumMarginalLogLikelihood

    torch.manual_seed(job["seed"])
    torch.set_num_threads(1)
    architectures = job["architectures"].split(",")
    several = len(architectures) > 1
    low, span = np.array(lower), np.array(upper) - np.array(lower)
    bounds = torch.tensor([[0.0] * 5 + [0.0] * several, [1.0] * 5 + [len(architectures) - 1.0] * several], dtype=torch.double)
    met, inputs, outputs = [], torch.empty(0, bounds.shape[1], dtype=torch.double), torch.empty(0, 3, dtype=torch.double)

    def evaluate(candidates):
        nonlocal inputs, outputs
        places = [int(round(row[5])) if several else 0 for row in candidates.tolist()]
        designs = [design_text(architectures[place], low + span * np.array(row[:5])) for place, row in zip(places, candidates.tolist())]
        answers = evaluator(designs)
        met.extend((design, answer["mass_kg"], answer["workspace_radius_m"]) for design, answer in zip(designs, answers))
        rows = [
            [-math.log(min(max(answer["mass_kg"], 1e-3), HEAVIEST)), answer["workspace_radius_m"], -answer["violation"]]
            for answer in answers
        ]
        inputs = torch.cat([inputs, candidates])
        outputs = torch.cat([outputs, torch.tensor(rows, dtype=torch.double)])

    sample = torch.quasirandom.SobolEngine(bounds.shape[1], scramble=True, seed=job["seed"]).draw(60, dtype=torch.double)
    if several:
        sample[:, 5] = torch.floor(sample[:, 5] * len(architectures)).clamp(max=len(architectures) - 1)
    evaluate(sample)
    # The hypervolume is that of the mass itself; ln mass is only what the model predicts.
    objective = GenericMCMultiOutputObjective(lambda y, X=None: torch.stack([-torch.exp(-y[..., 0]) / REFERENCE, y[..., 1]], dim=-1))
    fitted = None
    while len(met) < job["evaluations"]:
        kinds = (lambda y: MixedSingleTaskGP(inputs, y, cat_dims=[5], outcome_transform=Standardize(1))) if several else (
            lambda y: SingleTaskGP(inputs, y, outcome_transform=Standardize(1))
        )
        model = ModelListGP(*(kinds(outputs[:, [k]]) for k in range(3)))
        # The fit goes on from the last one, so that few steps are enough.
        if fitted is not None:
            model.load_state_dict(fitted, strict=False)
        fit_gpytorch_mll(SumMarginalLogLikelihood(model.likelihood, model), optimizer_kwargs={"options": {"maxiter": 20}})
        fitted = {name: value for name, value in model.state_dict().items() if "outcome_transform" not in name}
        reached = objective(outputs[outputs[:, 2] >= 0.0])
        gain = qLogExpectedHypervolumeImprovement(
            model=model,
            ref_point=[-1.0, 0.0],
            partitioning=FastNondominatedPartitioning(ref_point=torch.tensor([-1.0, 0.0], dtype=torch.double), Y=reached),
            sampler=SobolQMCNormalSampler(sample_shape=torch.Size([32]), seed=job["seed"]),
            objective=objective,
            constraints=[lambda y: -y[..., 2]],
        )
        options = {"q": 1, "num_restarts": 2, "raw_samples": 64, "options": {"maxiter": 20}}
        if several:
            fixed = [{5: float(place)} for place in range(len(architectures))]
            candidates, _ = optimize_acqf_mixed(gain, bounds, fixed_features_list=fixed, **options)
        else:
            candidates, _ = optimize_acqf(gain, bounds, **options)
        evaluate(candidates.detach())
    return met


def parego(job, evaluator, design_text, lower, upper):
    """Run ParEGO with SMAC's random forest. It has no constraints: an infeasible design is heavier than the reference point."""
    import tempfile

    from ConfigSpace import CategoricalHyperparameter, ConfigurationSpace, UniformFloatHyperparameter
    from smac import HyperparameterOptimizationFacade, Scenario
    from smac.multi_objective.parego import ParEGO

    architectures = job["architectures"].split(",")
    names = [f"x{k}" for k in range(5)]
    space = ConfigurationSpace(seed=job["seed"])
    space.add([UniformFloatHyperparameter(name, a, b) for name, a, b in zip(names, lower, upper)])
    space.add([CategoricalHyperparameter("architecture", architectures)])
    met = []

    def target(config, seed=0):
        design = design_text(config["architecture"], [config[name] for name in names])
        (answer,) = evaluator([design])
        met.append((design, answer["mass_kg"], answer["workspace_radius_m"]))
        if answer["violation"] > 0.0:
            return {"mass": math.log(REFERENCE) + min(answer["violation"], 10.0), "radius": 0.0}
        return {"mass": math.log(min(answer["mass_kg"], HEAVIEST)), "radius": -answer["workspace_radius_m"]}

    with tempfile.TemporaryDirectory() as folder:
        scenario = Scenario(
            space,
            objectives=["mass", "radius"],
            deterministic=True,
            n_trials=job["evaluations"],
            seed=job["seed"],
            output_directory=folder,
        )
        facade = HyperparameterOptimizationFacade(
            scenario, target, multi_objective_algorithm=ParEGO(scenario), overwrite=True, logging_level=40
        )
        facade.optimize()
    return met
