# Installs dem-pack and dem-run into a folder of the user, or into that which CRUMBLE_BIN names, and puts it on the user's PATH.
# At a release, the address of its files and its version take the places between @.
function Install-Crumble {
    $ErrorActionPreference = "Stop"
    $ProgressPreference = "SilentlyContinue"
    $address = if ($env:CRUMBLE_ADDRESS) { $env:CRUMBLE_ADDRESS } else { "@ADDRESS@" }
    $bin = if ($env:CRUMBLE_BIN) { $env:CRUMBLE_BIN } else { Join-Path $env:LOCALAPPDATA "Programs\crumble-dem" }
    $name = "crumble-dem-@VERSION@-windows-x86_64"
    $folder = Join-Path ([IO.Path]::GetTempPath()) ([Guid]::NewGuid())
    New-Item -ItemType Directory -Path $folder | Out-Null
    try {
        foreach ($file in "$name.zip", "SHA256SUMS") {
            Invoke-WebRequest -UseBasicParsing "$address/$file" -OutFile (Join-Path $folder $file)
        }
        $line = Get-Content (Join-Path $folder "SHA256SUMS") | Where-Object { $_.EndsWith(" $name.zip") }
        $found = (Get-FileHash -Algorithm SHA256 (Join-Path $folder "$name.zip")).Hash
        if (-not $line -or ($line -split " ")[0] -ne $found) {
            throw "$name.zip is damaged: its SHA-256 is not that in SHA256SUMS; try again"
        }
        Expand-Archive (Join-Path $folder "$name.zip") $folder
        New-Item -ItemType Directory -Force -Path $bin | Out-Null
        Copy-Item -Force (Join-Path $folder "$name\dem-*.exe") $bin
    } finally {
        Remove-Item -Recurse -Force $folder
    }
    $path = [Environment]::GetEnvironmentVariable("Path", "User")
    if (($path -split ";") -notcontains $bin) {
        [Environment]::SetEnvironmentVariable("Path", "$bin;$path", "User")
        $env:Path = "$bin;$env:Path"
    }
    Write-Output "dem-pack and dem-run @VERSION@ are in $bin."
}

Install-Crumble
